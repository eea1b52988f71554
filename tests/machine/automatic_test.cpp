// SPDX-License-Identifier: MIT
// Proves: what the host chooses by itself (grid, allocation, copies) is no worse than a fixed choice, in little memory.
// Cycles repeat exactly, so one run of each is enough. studies/automatic.toml does the same with a larger job.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

/// Heat is sampled, and what the smallest loads leave over does not divide evenly.
constexpr double kTolerance = 1.03;

double cycles_with(const std::function<void(MachineChoice&)>& choose) {
  RenderCase room = native_case(source_dir() / "scenes/interior");
  room.quality.hemicube = 32;  // with so few records as 8 bring, copies are not worth their loading
  room.quality.max_shots = 60;
  room.quality.samples = 2;
  room.machine = {};
  room.machine.engine = "translated";
  room.machine.columns = room.machine.rows = 4;
  room.machine.pe_memory = 2U << 20U;
  choose(room.machine);
  const RenderFigures figures = run_case(room).figures;
  return static_cast<double>(figures.load_cycles + figures.radiosity_cycles + figures.ray_tracing_cycles);
}

TEST(Automatic, IsNoWorseThanFixedChoices) {
  const double automatic = cycles_with([](MachineChoice&) {});
  std::vector<std::pair<std::string, std::function<void(MachineChoice&)>>> choices;
  for (const std::array<std::uint32_t, 3>& cells : {std::array{8U, 3U, 5U}, {15U, 5U, 10U}, {40U, 12U, 26U}}) {
    choices.emplace_back("subspaces " + std::to_string(cells[0]),
                         [cells](MachineChoice& machine) { machine.subspaces = cells; });
  }
  for (const char* allocation : {"modulo", "skewed"}) {
    choices.emplace_back(allocation, [allocation](MachineChoice& machine) { machine.allocation = allocation; });
  }
  for (const double replicate : {0.0, 0.2}) {
    choices.emplace_back("replicate " + std::to_string(replicate),
                         [replicate](MachineChoice& machine) { machine.replicate = replicate; });
  }
  for (const auto& [name, choose] : choices) {
    EXPECT_LE(automatic, kTolerance * cycles_with(choose)) << name;
  }
}

}  // namespace
}  // namespace torolux::test
