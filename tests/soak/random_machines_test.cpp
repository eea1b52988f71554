// SPDX-License-Identifier: MIT
// Machines by chance: whatever their size, links, credits, faults, memory and grid, and however they share out scene
// and work, they make the same picture to the bit, and the same machine does the same to the cycle.
// TOROLUX_SOAK_SECONDS: go on with further seeds for so long.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <map>

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

/// Of one side of the grid: 1 is the least, beyond 9 most subspaces are empty.
std::uint32_t cells_of_side(MachineDice& dice) {
  return dice.chance(6) ? dice.number(10, 24) : dice.number(1, 9);
}

/// One of the two schemes, and half of the time each step of the other by chance.
void share_out(MachineDice& dice, MachineChoice& machine) {
  take_scheme(machine, dice.chance(2) ? Scheme::paper : Scheme::spread);
  if (dice.chance(2)) machine.points = dice.chance(2) ? Points::travel : Points::stay;
  if (dice.chance(2)) machine.empty = dice.chance(2) ? Empty::over : Empty::enter;
  if (dice.chance(2)) machine.camera_rays = dice.chance(2) ? RayMaker::pes : RayMaker::host;
  if (dice.chance(2)) machine.replicate = dice.chance(4) ? dice.number(0, 1) : dice.number(0, 200) * 1e-3;
  const std::array<const char*, 7> allocations = {"skewed", "skewed:yz", "skewed:xy", "skewed-both",
                                                  "modulo", "block",     "balanced"};
  if (!dice.chance(3)) machine.allocation = allocations[dice.number(0, allocations.size() - 1)];
  machine.skip_empty_subspaces = dice.chance(2);
}

/// A third of the machines choose their memory, a third have the page that their fullest PE needs without copies and
/// no more, the others some room beyond it, for copies.
void draw_memory(MachineDice& dice, RenderCase& render_case) {
  const std::uint32_t kind = dice.number(1, 3);
  if (kind == 1 || !render_case.machine.subspaces) return;  // a grid that is chosen hangs on the memory
  RenderCase without = render_case;
  // Nothing fits into so little; the stages have placements of their own all the same.
  constexpr double kTooLittle = 1e-9;
  if (without.machine.replicate != 0.0) without.machine.replicate = kTooLittle;
  const Scene scene = load_scene(without.scene, {});
  const std::uint32_t needed =
      plan(scene, scene.camera.value(), without.quality, without.machine, pe_image()).local_memory_needed;
  const std::uint32_t pages = (needed + protocol::kPageBytes - 1) / protocol::kPageBytes;
  const std::uint32_t more = kind == 2 ? 0 : dice.number(1, 64);
  render_case.machine.pe_memory =
      std::max(protocol::kSmallestLocalMemory, static_cast<std::uint32_t>((pages + more) * protocol::kPageBytes));
}

RenderCase case_of(std::uint32_t seed) {
  MachineDice dice(seed);
  RenderCase result = small_scene();
  MachineChoice& machine = result.machine;
  machine.description = dice.description();
  machine.columns = dice.number(1, 6);
  machine.rows = dice.number(1, 6);
  if (!dice.chance(6)) machine.subspaces = {cells_of_side(dice), cells_of_side(dice), cells_of_side(dice)};
  share_out(dice, machine);
  draw_memory(dice, result);
  machine.threads = dice.number(1, 4);
  if (dice.chance(4)) machine.engine = "translated";
  return result;
}

/// For the message of a test that fails.
std::string describe(const MachineChoice& machine) {
  std::ostringstream text;
  text << to_text(machine.description, machine.columns, machine.rows) << ", scheme " << name_of(machine.scheme)
       << ", points " << name_of(machine.points) << ", empty " << name_of(machine.empty) << ", camera rays "
       << name_of(machine.camera_rays) << (machine.skip_empty_subspaces ? "" : " from the outermost") << ", replicate ";
  machine.replicate ? text << *machine.replicate : text << "what fits";
  text << ", allocation " << machine.allocation << ", memory ";
  machine.pe_memory ? text << *machine.pe_memory : text << "auto";
  text << ", grid ";
  machine.subspaces
      ? text << (*machine.subspaces)[0] << 'x' << (*machine.subspaces)[1] << 'x' << (*machine.subspaces)[2]
      : text << "auto";
  text << ", engine " << machine.engine << " on " << machine.threads << " threads";
  return text.str();
}

/// What the machines had, so that a draw that never comes up is seen.
class Drawn {
 public:
  void add(const RenderCase& render_case, const RenderFigures& figures) {
    const MachineChoice& machine = render_case.machine;
    ++seen_["scheme " + std::string(name_of(machine.scheme))];
    ++seen_["points " + std::string(name_of(machine.points))];
    ++seen_["empty " + std::string(name_of(machine.empty))];
    ++seen_["camera rays " + std::string(name_of(machine.camera_rays))];
    ++seen_["allocation " + machine.allocation];
    ++seen_["engine " + machine.engine];
    ++seen_[machine.pe_memory ? "memory given" : "memory chosen"];
    ++seen_[machine.subspaces ? "grid given" : "grid chosen"];
    const MachineDescription& description = machine.description;
    if (description.records.niu_slots == 16 && description.niu.receive_packets == 1) ++seen_["the least of everything"];
    if (description.records.credits_per_pe == 1) ++seen_["one credit"];
    const std::uint64_t copies = figures.radiosity_copies.cells + figures.ray_tracing_copies.cells;
    ++seen_[copies != 0 ? "copies" : "no copies"];
    for (const PeFigures& pe : figures.machine.pes) seen_["records diverted"] += pe.records_diverted;
    seen_["packet hops"] += figures.machine.packets.hops;
    seen_["link retries"] += figures.machine.link_retries;
  }
  std::uint64_t count(const std::string& what) const { return seen_.contains(what) ? seen_.at(what) : 0; }
  void print() const {
    for (const auto& [what, times] : seen_)
      std::printf("  %s: %llu\n", what.c_str(), static_cast<unsigned long long>(times));
  }

 private:
  std::map<std::string, std::uint64_t> seen_;
};

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

double soak_seconds() {
  const char* text = std::getenv("TOROLUX_SOAK_SECONDS");  // NOLINT(concurrency-mt-unsafe): before any thread
  return text != nullptr ? std::strtod(text, nullptr) : 0;
}

void expect_one_picture(std::uint32_t seed, const std::vector<std::byte>& picture, Drawn& drawn) {
  const RenderCase render_case = case_of(seed);
  SCOPED_TRACE("seed " + std::to_string(seed) + ": " + describe(render_case.machine));
  const RenderResult result = run_case(render_case);
  ASSERT_EQ(bytes_of(result.picture), picture);
  expect_all_home(result.figures);
  for (const PeFigures& pe : result.figures.machine.pes) {
    EXPECT_LE(pe.record_slots_high_water, render_case.machine.description.records.niu_slots);
  }
  drawn.add(render_case, result.figures);
  if (seed % 5 != 0) return;
  RenderCase again = render_case;
  again.machine.threads = again.machine.threads % 4 + 1;
  ASSERT_EQ(exact_figures(run_case(again).figures), exact_figures(result.figures));
}

TEST(RandomMachines, MakeOnePicture) {
  const std::vector<std::byte> picture = bytes_of(run_case(small_scene()).picture);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(soak_seconds());
  Drawn drawn;
  std::uint32_t seed = 0;
  while (seed < 100 || std::chrono::steady_clock::now() < end) {
    expect_one_picture(++seed, picture, drawn);
    if (HasFailure()) FAIL() << "at seed " << seed;
  }
  std::printf("%u machines:\n", seed);
  drawn.print();
  for (const char* what : {"scheme spread", "scheme paper", "points travel", "points stay", "empty over", "empty enter",
                           "camera rays pes", "camera rays host", "memory given", "memory chosen", "grid chosen",
                           "copies", "no copies", "engine translated", "the least of everything"}) {
    EXPECT_GT(drawn.count(what), 10U) << "some machines are to have: " << what;
  }
  EXPECT_GT(drawn.count("one credit"), 2U);
  EXPECT_GT(drawn.count("records diverted"), 1000U) << "the machines are to be forced to divert";
  EXPECT_GT(drawn.count("link retries"), 1000U) << "and to send again";
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
