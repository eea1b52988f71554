// SPDX-License-Identifier: MIT
// Machines by chance: whatever their size, links, credits, faults, allocation and grid, they make the same picture to
// the bit, and the same machine does the same to the cycle.
#include <gtest/gtest.h>

#include "tests/soak/random_machine.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

/// Mirror and glass too, so that rays branch.
RenderCase small_scene() {
  RenderCase result = native_case(source_dir() / "scenes" / "cornell_spheres");
  result.quality.width = result.quality.height = 24;
  result.quality.hemicube = 8;
  result.quality.shot_points = 1;
  result.quality.max_shots = 40;
  result.quality.patch_length = 250;
  result.quality.element_length = 125;
  return result;
}

RenderCase case_of(std::uint32_t seed) {
  MachineDice dice(seed);
  RenderCase result = small_scene();
  MachineChoice& machine = result.machine;
  machine.description = dice.description();
  machine.columns = dice.number(1, 6);
  machine.rows = dice.number(1, 6);
  machine.subspaces = {dice.number(1, 9), dice.number(1, 9), dice.number(1, 9)};
  const std::array<const char*, 7> allocations = {"skewed", "skewed:yz", "skewed:xy", "skewed-both",
                                                  "modulo", "block",     "balanced"};
  machine.allocation = allocations[dice.number(0, 6)];
  machine.skip_empty_subspaces = dice.chance(2);
  machine.threads = dice.number(1, 4);
  return result;
}

void expect_all_home(const RenderFigures& figures) {
  EXPECT_EQ(figures.credits_home, figures.credits_total);
  std::uint64_t sent = 0;
  std::uint64_t delivered = 0;
  for (const PeFigures& pe : figures.machine.pes) {
    sent += pe.packets_sent;
    delivered += pe.packets_delivered;
  }
  EXPECT_EQ(sent, delivered);
  EXPECT_LT(energy_error(figures.energy), 1e-5);
}

TEST(RandomMachines, MakeOnePicture) {
  const std::vector<std::byte> picture = bytes_of(run_case(small_scene()).picture);
  std::uint64_t diverted = 0;
  std::uint64_t retries = 0;
  unsigned least = 0;
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    const RenderCase render_case = case_of(seed);
    const MachineChoice& machine = render_case.machine;
    if (machine.description.records.niu_slots == 16 && machine.description.niu.receive_packets == 1) ++least;
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + to_text(machine.description, machine.columns, machine.rows) +
                 ", " + machine.allocation);
    const RenderResult result = run_case(render_case);
    ASSERT_EQ(bytes_of(result.picture), picture);
    expect_all_home(result.figures);
    for (const PeFigures& pe : result.figures.machine.pes) diverted += pe.records_diverted;
    retries += result.figures.machine.link_retries;
    if (seed % 5 != 0) continue;
    ASSERT_EQ(exact_figures(run_case(render_case).figures), exact_figures(result.figures));
  }
  EXPECT_GT(least, 10U) << "some machines are to have the least of everything";
  EXPECT_GT(diverted, 1000U) << "the machines are to be forced to divert";
  EXPECT_GT(retries, 1000U) << "and to send again";
}

TEST(RandomMachines, JitterAndFaultsDoNotShow) {
  RenderCase render_case = small_scene();
  const std::vector<std::byte> picture = bytes_of(run_case(render_case).picture);
  render_case.machine.columns = render_case.machine.rows = 3;
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    render_case.machine.description.jitter.seed = seed;
    render_case.machine.description.torus.link_error_rate = seed % 4 == 0 ? 0.1 : 0;
    const RenderResult result = run_case(render_case);
    ASSERT_EQ(bytes_of(result.picture), picture) << "seed " << seed;
    expect_all_home(result.figures);
  }
}

}  // namespace
}  // namespace torolux::test
