// SPDX-License-Identifier: MIT
// Profiles of real images: exact numbers where they are known, sums that must hold wherever, and a run that is the same
// with a profile and without.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/profile/function_totals.hpp"
#include "host_tools/profile/profile_text.hpp"
#include "host_tools/profile/speedscope.hpp"
#include "host_tools/run/run.hpp"
#include "tests/translated/assembler.hpp"
#include "tests/unit/emulator/engines/elf_builder.hpp"

namespace torolux {
namespace {

using testing::HasSubstr;

Image image_of(const std::string& name) {
  return load_image(std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (name + ".elf"));
}

MachineSetup machine_of(unsigned columns, unsigned rows, unsigned threads = 1) {
  MachineSetup setup;
  setup.columns = columns;
  setup.rows = rows;
  setup.engine = kInterpretedEngine;
  setup.threads = threads;
  return setup;
}

/// A run and its profile, of all PEs together.
struct Profiled {
  explicit Profiled(const std::string& image, unsigned columns, unsigned rows, unsigned threads = 1) {
    MachineSetup setup = machine_of(columns, rows, threads);
    setup.profile = &profile;
    figures = run_image(setup, image_of(image), [](const PeText&) {}, {});
    pes.resize(profile.pes());
    std::iota(pes.begin(), pes.end(), 0U);
  }
  ProfileNames names() const { return ProfileNames(profile); }
  PathTree tree() const { return paths_of(profile, names(), pes); }

  profile::CycleProfile profile;
  MachineFigures figures;
  std::vector<unsigned> pes;
};

struct Counts {
  std::uint64_t calls, self;
  bool operator==(const Counts&) const = default;
};
void PrintTo(const Counts& counts, std::ostream* out) {  // NOLINT(readability-identifier-naming): GoogleTest's name
  *out << counts.calls << " calls, " << counts.self << " cycles";
}

/// By the part of each path that begins with `root`: "outer;inner".
std::map<std::string, Counts> below(const Profiled& profiled, const std::string& root) {
  const ProfileNames names = profiled.names();
  const PathTree tree = profiled.tree();
  std::map<std::string, Counts> result;
  std::vector<std::string> text(tree.paths.size());
  for (std::size_t i = 1; i < tree.paths.size(); ++i) {
    const Path& path = tree.paths[i];
    const std::string& name = names.all()[path.name];
    const std::string& parent = text[path.parent];
    text[i] = parent.empty() ? (name == root ? name : "") : parent + ";" + name;
    if (!text[i].empty()) result[text[i]] = {path.calls, path.self};
  }
  return result;
}

TEST(Profile, CountsWhatIsKnownExactly) {
  const Profiled profiled("known_calls", 2, 1);
  const std::map<std::string, Counts> expected = {
      {"all_calls", {1, 21}},
      {"all_calls;by_tail", {1, 3}},
      {"all_calls;leaf", {1, 3}},  // by_tail's, in its place
      {"all_calls;by_pointer", {1, 8}},
      {"all_calls;by_pointer;leaf", {1, 3}},
      {"all_calls;countdown", {1, 12}},
      {"all_calls;countdown;countdown", {1, 12}},
      {"all_calls;countdown;countdown;countdown", {1, 12}},
      {"all_calls;countdown;countdown;countdown;countdown", {1, 9}},
      {"all_calls;by_other_link", {2, 16}},
  };
  EXPECT_EQ(below(profiled, "all_calls"), expected);
}

TEST(Profile, FollowsLongjmpAndTheHelpersOfTheCompiler) {
  const Profiled profiled("known_calls", 2, 1);
  const auto lands = below(profiled, "lands");
  EXPECT_EQ(lands.count("lands;climbs;climbs;climbs;climbs;longjmp"), 1U);
  EXPECT_EQ(lands.at("lands;leaf"), (Counts{1, 3})) << "called after the jump back";
  EXPECT_EQ(lands.at("lands;setjmp").calls, 1U);
  const auto keeps = below(profiled, "keeps");
  EXPECT_EQ(keeps.at("keeps;leaf"), (Counts{3, 9}));
  const auto helper = [&](const std::string& name) {
    return std::any_of(keeps.begin(), keeps.end(), [&](const auto& path) { return path.first.starts_with(name); });
  };
  EXPECT_TRUE(helper("keeps;__riscv_save_"));
  EXPECT_TRUE(helper("keeps;__riscv_restore_"));
}

TEST(Profile, ShowsWaitsUnderTheFunctionThatWaits) {
  const Profiled profiled("known_calls", 2, 1);
  const std::uint64_t waited = profiled.figures.pes[1].waits[static_cast<std::size_t>(WaitReason::arrivals)];
  EXPECT_GT(waited, 0U);
  EXPECT_EQ(below(profiled, "waits_for_it").at("waits_for_it;[waits: receive]"), (Counts{0, waited}));
}

TEST(Profile, SumsOverRecursionAndPes) {
  const Profiled profiled("known_calls", 2, 1);
  const ProfileNames names = profiled.names();
  const ProfileTotals totals = totals_of(profiled.profile, names, profiled.pes, profiled.tree());
  const auto of = [&](const std::string& name) {
    for (const FunctionTotals& function : totals.functions) {
      if (names.all()[function.name] == name) return function;
    }
    ADD_FAILURE() << name;
    return totals.functions.front();
  };
  const FunctionTotals countdown = of("countdown");
  EXPECT_EQ(countdown.calls, 4U);
  EXPECT_EQ(countdown.self, 45U);
  EXPECT_EQ(countdown.total, 45U) << "each cycle once, though it calls itself";
  EXPECT_EQ(countdown.spread.least, 0U);
  EXPECT_EQ(countdown.spread.least_pe, 1U);
  EXPECT_EQ(countdown.spread.most, 45U);
  EXPECT_EQ(countdown.spread.most_pe, 0U);
  EXPECT_EQ(countdown.spread.mean, 22.5);
  EXPECT_EQ(of("all_calls").total, 21U + 3 + 3 + 8 + 3 + 45 + 16);
  EXPECT_EQ(of("waits_for_it").waits, of("[waits: receive]").self);
  EXPECT_EQ(of("_start").total, totals.cycles);
  for (std::size_t i = 1; i < totals.functions.size(); ++i)
    EXPECT_GE(totals.functions[i - 1].self, totals.functions[i].self);
}

TEST(Profile, OfOnePeIsItsOwn) {
  const Profiled profiled("known_calls", 2, 1);
  const ProfileNames names = profiled.names();
  const std::vector<unsigned> one = {1};
  const std::string folded = folded_paths(paths_of(profiled.profile, names, one), names);
  EXPECT_THAT(folded, HasSubstr("waits_for_it;[waits: receive] "));
  EXPECT_THAT(folded, testing::Not(HasSubstr("all_calls")));
}

/// first ends with its HINT, and second begins behind it.
TEST(Profile, AHintBelongsToTheFunctionThatItStandsIn) {
  test::ElfPlan plan;
  plan.code = {test::addi(0, 0, 0), test::hint(protocol::Hint::clock), test::hint(protocol::Hint::halt)};
  plan.symbols = {{"first", 0x8000'0000U, 8}, {"second", 0x8000'0008U, 4}};
  profile::CycleProfile profile;
  MachineSetup setup = machine_of(1, 1);
  setup.profile = &profile;
  run_image(setup, parse_image(test::build_elf(plan), "hints.elf"), [](const PeText&) {}, {});
  const ProfileNames names(profile);
  const std::vector<unsigned> one = {0};
  EXPECT_EQ(folded_paths(paths_of(profile, names, one), names), "first 3\nsecond 2\n");
}

class ProfiledImages : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Images, ProfiledImages,
                         testing::Values("hello", "token", "known_calls", "jumps", "kit_hello"));

/// All cycles of a PE are some function's own, or a wait for its reason.
TEST_P(ProfiledImages, NoCycleIsLost) {
  const Profiled profiled(GetParam(), 3, 2);
  ASSERT_EQ(profiled.profile.pes(), 6U);
  for (std::size_t pe = 0; pe < profiled.profile.pes(); ++pe) {
    std::uint64_t self = 0;
    WaitCycles waits{};
    for (const profile::CallNode& node : profiled.profile.pe(pe).tree().nodes()) {
      self += node.self;
      for (std::size_t reason = 0; reason < kWaitReasons; ++reason) waits[reason] += node.waits[reason];
    }
    EXPECT_EQ(self, profiled.figures.pes[pe].busy_cycles) << "PE " << pe;
    EXPECT_EQ(waits, profiled.figures.pes[pe].waits) << "PE " << pe;
  }
  const PathTree tree = profiled.tree();
  std::uint64_t sum = 0;
  for (const Path& path : tree.paths) sum += path.self;
  EXPECT_EQ(sum, tree.cycles());
}

TEST_P(ProfiledImages, ARunDoesNotNoticeItsProfile) {
  const MachineFigures plain = run_image(machine_of(3, 2), image_of(GetParam()), [](const PeText&) {}, {});
  const Profiled profiled(GetParam(), 3, 2);
  EXPECT_EQ(profiled.figures.trace_hash, plain.trace_hash);
  EXPECT_EQ(profiled.figures.now, plain.now);
  EXPECT_EQ(profiled.figures.instructions(), plain.instructions());
  MachineSetup translated = machine_of(3, 2);
  translated.engine = kDefaultEngine;
  EXPECT_EQ(run_image(translated, image_of(GetParam()), [](const PeText&) {}, {}).trace_hash, plain.trace_hash);
}

TEST_P(ProfiledImages, TheProfileIsTheSameOnAnyNumberOfThreads) {
  const Profiled one(GetParam(), 3, 2, 1), four(GetParam(), 3, 2, 4);
  EXPECT_EQ(folded_paths(one.tree(), one.names()), folded_paths(four.tree(), four.names()));
}

TEST(Profile, IsRefusedOnOtherEngines) {
  profile::CycleProfile profile;
  for (const char* engine : {"translated", "qemu"}) {
    MachineSetup setup = machine_of(1, 1);
    setup.engine = engine;
    setup.profile = &profile;
    EXPECT_THROW(run_image(setup, image_of("hello"), [](const PeText&) {}, {}), UsageError) << engine;
  }
  MachineSetup setup = machine_of(2, 1);
  setup.debugging.qemu_pes = {1};
  setup.profile = &profile;
  EXPECT_THROW(run_image(setup, image_of("hello"), [](const PeText&) {}, {}), UsageError);
}

// What the format asks for: https://github.com/jlfwong/speedscope, src/lib/file-format-spec.ts.
TEST(SpeedscopeFile, KeepsTheRulesOfItsFormat) {
  const Profiled profiled("token", 3, 2);
  const ProfileNames names = profiled.names();
  std::string text;
  write_speedscope(profiled.profile, names, profiled.pes, "token.elf", [&](std::string_view part) { text += part; });
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json.at("$schema"), "https://www.speedscope.app/file-format-schema.json");
  EXPECT_EQ(json.at("name"), "token.elf");
  const auto& frames = json.at("shared").at("frames");
  for (const auto& frame : frames) EXPECT_TRUE(frame.at("name").is_string());
  const auto& profiles = json.at("profiles");
  ASSERT_EQ(profiles.size(), 7U);
  EXPECT_LT(json.at("activeProfileIndex").get<std::size_t>(), profiles.size());
  EXPECT_EQ(profiles[0].at("name"), "all PEs");
  EXPECT_EQ(profiles[6].at("name"), "PE 5");
  std::uint64_t sum_of_pes = 0;
  for (const auto& one : profiles) {
    EXPECT_EQ(one.at("type"), "sampled");
    EXPECT_EQ(one.at("unit"), "none");
    EXPECT_EQ(one.at("startValue"), 0);
    ASSERT_EQ(one.at("samples").size(), one.at("weights").size());
    std::uint64_t sum = 0;
    for (const auto& weight : one.at("weights")) sum += weight.get<std::uint64_t>();
    EXPECT_EQ(one.at("endValue"), sum);
    if (&one != &profiles[0]) sum_of_pes += sum;
    for (const auto& stack : one.at("samples")) {
      EXPECT_FALSE(stack.empty());
      for (const auto& frame : stack) EXPECT_LT(frame.get<std::size_t>(), frames.size());
    }
  }
  EXPECT_EQ(profiles[0].at("endValue"), sum_of_pes);
}

}  // namespace
}  // namespace torolux
