// SPDX-License-Identifier: MIT
// See element_report.hpp.
#include "tests/accuracy/element_report.hpp"

#include <cmath>

#include "tests/accuracy/table.hpp"
#include "tests/support/dense_errors.hpp"
#include "tests/support/form_factor_cases.hpp"

namespace torolux::accuracy {
namespace {

/// Of one shot.
struct ShotSetting {
  std::uint32_t hemicube, shot_points;
};
constexpr std::array<ShotSetting, 4> kShots = {{{16, 1}, {16, 2}, {16, 4}, {32, 4}}};

}  // namespace

void report_form_factors(const ReportChoice& choice) {
  std::filesystem::create_directories(choice.output);
  Table table({"shapes", "hemicube", "shot points", "exact", "measured", "difference", "difference [%]"});
  for (const ShotSetting& shot : kShots) {
    for (const test::FormFactorCase& shapes : test::form_factor_cases()) {
      Quality quality;
      quality.hemicube = shot.hemicube;
      quality.shot_points = shot.shot_points;
      const double measured = test::measured_form_factor(shapes, quality);
      table.add({shapes.name, std::to_string(shot.hemicube), std::to_string(shot.shot_points),
                 text_of("%.6f", shapes.exact), text_of("%.6f", measured), text_of("%+.6f", measured - shapes.exact),
                 text_of("%+.3f", 100 * (measured / shapes.exact - 1))});
    }
  }
  table.write(choice.output / "form_factors");
}

void report_dense(const ReportChoice& choice) {
  std::filesystem::create_directories(choice.output);
  struct Room {
    const char* name;
    double length;
    unsigned visibility_rays;
  };
  Table table(
      {"scene", "longest edge", "elements", "hemicube", "shot points", "RMSE [%]", "worst element [%]", "records"});
  for (const Room& room : {Room{"furnace", 0.75, 0}, Room{"lamp_room", 0.75, 0}, Room{"post_room", 0.75, 32},
                           Room{"lamp_room", 0.25, 0}, Room{"post_room", 0.25, 8}}) {
    for (const ShotSetting& shot : kShots) {
      test::RenderCase solve = test::native_case(test::data_dir() / "scenes" / room.name);
      solve.machine.subspaces = {2, 2, 2};
      solve.quality.patch_length = solve.quality.element_length = room.length;
      solve.quality.hemicube = shot.hemicube;
      solve.quality.shot_points = shot.shot_points;
      solve.quality.unshot = 1e-5;
      const test::SolvedScene solved = test::solve_scene(solve);
      const test::DenseErrors errors = test::dense_errors(solved, room.visibility_rays);
      table.add({room.name, text_of("%g", room.length), std::to_string(errors.elements), std::to_string(shot.hemicube),
                 std::to_string(shot.shot_points), text_of("%.2f", 100 * errors.rmse),
                 text_of("%.2f", 100 * errors.worst), std::to_string(solved.figures.radiosity_records)});
    }
  }
  table.write(choice.output / "dense");
}

}  // namespace torolux::accuracy
