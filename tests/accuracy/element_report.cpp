// SPDX-License-Identifier: MIT
// Pairs of shapes are rendered at each setting, rooms solved with more and more points of a shot; the tables
// form_factors and dense leave.
#include "tests/accuracy/element_report.hpp"

#include <cmath>

#include "tests/accuracy/table.hpp"
#include "tests/support/dense_errors.hpp"
#include "tests/support/form_factor_cases.hpp"

namespace torolux::accuracy {
namespace {

constexpr std::array<std::uint32_t, 4> kDensePoints = {4, 8, 16, 24};

}  // namespace

void report_form_factors(const ReportChoice& choice) {
  std::filesystem::create_directories(choice.output);
  Table table({"shapes", "setting", "exact", "measured", "difference", "difference [%]"});
  for (const Setting& setting : chosen_settings(choice)) {
    for (const test::FormFactorCase& shapes : test::form_factor_cases()) {
      Quality quality;
      apply(setting, quality);
      quality.shadow_rays = false;
      quality.refine = 0;
      const double measured = test::measured_form_factor(shapes, quality);
      table.add({shapes.name, std::string(setting.name), text_of("%.6f", shapes.exact), text_of("%.6f", measured),
                 text_of("%+.6f", measured - shapes.exact), text_of("%+.3f", 100 * (measured / shapes.exact - 1))});
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
  Table table({"scene", "longest edge", "elements", "shot points", "RMSE [%]", "worst element [%]", "records"});
  for (const Room& room : {Room{"furnace", 0.75, 0}, Room{"lamp_room", 0.75, 0}, Room{"post_room", 0.75, 32},
                           Room{"lamp_room", 0.25, 0}, Room{"post_room", 0.25, 8}}) {
    for (const std::uint32_t points : kDensePoints) {
      test::RenderCase solve = test::native_case(test::data_dir() / "scenes" / room.name);
      solve.machine.subspaces = {2, 2, 2};
      solve.quality.patch_length = solve.quality.element_length = room.length;
      solve.quality.hemicube = 16;
      solve.quality.shot_points = points;
      solve.quality.emission_records = 30'000'000;
      solve.quality.unshot = 1e-5;
      const test::SolvedScene solved = test::solve_scene(solve);
      const test::DenseErrors errors = test::dense_errors(solved, room.visibility_rays);
      table.add({room.name, text_of("%g", room.length), std::to_string(errors.elements), std::to_string(points),
                 text_of("%.2f", 100 * errors.rmse), text_of("%.2f", 100 * errors.worst),
                 std::to_string(solved.figures.radiosity_records)});
    }
  }
  table.write(choice.output / "dense");
}

}  // namespace torolux::accuracy
