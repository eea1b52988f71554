// SPDX-License-Identifier: MIT
// Proves: every way to end a command has its exit code, messages name what was wrong, help is complete, compare works
// from the command line.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <iostream>
#include <limits>

#include "host_tools/cli/command.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/picture/picture.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/host_tools/cli/run_main.hpp"

namespace torolux {
namespace {

using testing::HasSubstr;
using testing_support::TemporaryFolder;

TEST(Main, HelpAndVersionAreNoErrors) {
  EXPECT_EQ(torolux({"--help"}).code, 0);
  EXPECT_EQ(torolux({"render", "--help"}).code, 0);
  const Outcome version = torolux({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, testing::StartsWith("torolux "));
  for (const char* part : {"commit: ", "protocol: ", "translated (default)"}) EXPECT_THAT(version.out, HasSubstr(part));
}

TEST(Main, HelpOfRenderIsComplete) {
  const std::string help = torolux({"render", "--help"}).out;
  for (const char* option : {"SCENE",
                             "--output",
                             "--size",
                             "--samples",
                             "--eye",
                             "--look-at",
                             "--up",
                             "--fov",
                             "--exposure",
                             "--pes",
                             "--pe-memory",
                             "--subspaces",
                             "--scheme",
                             "--allocation",
                             "--replicate",
                             "--points",
                             "--empty",
                             "--camera-rays",
                             "--machine",
                             "--engine",
                             "--patches",
                             "--elements",
                             "--hemicube",
                             "--shot-points",
                             "--emission-records",
                             "--unshot",
                             "--max-shots",
                             "--bounces",
                             "--two-sided-lights",
                             "--save-radiosity",
                             "--radiosity",
                             "--stats",
                             "--seed",
                             "--threads",
                             "--quiet",
                             "--studio",
                             "--enter-empty",
                             "--direct",
                             "--filter",
                             "--tone-curve",
                             "--layers",
                             "--no-picture",
                             "--set",
                             "--jitter",
                             "--fault",
                             "--stats-csv",
                             "--strict",
                             "--missing-materials"})
    EXPECT_THAT(help, HasSubstr(option));
  for (const char* text : {"[512x512]", "[4x4]", "[balanced; --scheme paper: skewed]", "[16;", "[0.002]", "[32]",
                           "degrees", "scene units"})
    EXPECT_THAT(help, HasSubstr(text));
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
}

TEST(Main, AloneItSaysWhereToBegin) {
  const Outcome alone = torolux({});
  EXPECT_EQ(alone.code, 0);
  EXPECT_THAT(alone.out, HasSubstr("torolux render cornell_box"));
  EXPECT_THAT(alone.out, HasSubstr("two_mirrors")) << "the scenes that are here";
}

TEST(Main, ScenesThatCameWithTheProgramAreFoundByName) {
  const Outcome by_name = torolux({"info", "two_mirrors"});
  const Outcome by_path = torolux({"info", std::string(TOROLUX_SOURCE_DIR) + "/scenes/two_mirrors"});
  EXPECT_EQ(by_name.code, 0) << by_name.err;
  EXPECT_THAT(by_name.out, HasSubstr("1 830"));
  const auto before_predictions = [](const std::string& text) { return text.substr(0, text.find("predicted")); };
  EXPECT_EQ(before_predictions(by_name.out), before_predictions(by_path.out));
  EXPECT_EQ(torolux({"info", "./two_mirrors"}).code, 2) << "a path is meant, not a name";
}

TEST(Main, UsageErrors) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"paint"},
                                             {"render"},
                                             {"render", "scene", "--colour"},
                                             {"render", "scene", "--size"},
                                             {"render", "scene", "--size", "640"},
                                             {"render", "scene", "--eye", "1,2"},
                                             {"render", "scene", "--pes", "4"},
                                             {"render", "scene", "--pe-memory", "1G"},
                                             {"render", "scene", "--engine", "steam"},
                                             {"render", "scene", "--allocation", "heaps"},
                                             {"render", "scene", "--scheme", "paperback"},
                                             {"render", "scene", "--points", "wander"},
                                             {"render", "scene", "--empty", "under"},
                                             {"render", "scene", "--camera-rays", "eye"},
                                             {"render", "scene", "--output", ""},
                                             {"render", "scene", "--direct", "lamp"},
                                             {"render", "scene", "--filter", "triangle"},
                                             {"render", "scene", "--tone-curve", "aces"},
                                             {"render", "scene", "--layers", "colour"},
                                             {"render", "scene", "--missing-materials", "black"},
                                             {"render", "scene", "--set", "torus.flit_bytes"},
                                             {"run", "a.elf", "--set", "=16"},
                                             {"tonemap", "a.exr"},
                                             {"tonemap", "a.exr", "a.jpg"},
                                             {"tonemap", "a.exr", "b.exr"},
                                             {"tonemap", "a.exr", "b.png", "--tone-curve", "aces"},
                                             {"compare", "a.pfm"}}) {
    const Outcome outcome = torolux(arguments);
    EXPECT_EQ(outcome.code, 1) << testing::PrintToString(arguments);
    EXPECT_NE(outcome.err, "") << testing::PrintToString(arguments);
  }
}

TEST(Main, ValuesThatAreNotAllowedAreBadInputAndNameTheOption) {
  const std::vector<std::array<const char*, 2>> cases = {{"--pes", "0x4"},
                                                         {"--pes", "256x256"},
                                                         {"--size", "0x10"},
                                                         {"--samples", "0"},
                                                         {"--hemicube", "15"},
                                                         {"--hemicube", "258"},
                                                         {"--shot-points", "0"},
                                                         {"--shot-points", "65"},
                                                         {"--unshot", "0"},
                                                         {"--unshot", "1.5"},
                                                         {"--bounces", "256"},
                                                         {"--fov", "180"},
                                                         {"--fov", "0"},
                                                         {"--pe-memory", "128K"},
                                                         {"--patches", "0"},
                                                         {"--subspaces", "0x1x1"},
                                                         {"--threads", "0"},
                                                         {"--exposure", "1000"},
                                                         {"--set", "torus.flit_bytes=0"},
                                                         {"--set", "torus.flit=1"}};
  for (const auto& [option, value] : cases) {
    const Outcome outcome = torolux({"render", "scene", option, value});
    EXPECT_EQ(outcome.code, 2) << option << " " << value;
    EXPECT_THAT(outcome.err, HasSubstr(option));
    EXPECT_THAT(outcome.err, HasSubstr(value));
  }
}

TEST(Main, NegativeCoordinatesAreValuesNotOptions) {
  // It gets as far as the scene, which is not there.
  const Outcome outcome =
      torolux({"render", "/nowhere", "--eye", "-1,2,3", "--look-at", "-.5,0,0", "--exposure", "-1"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("/nowhere"));
}

TEST(Main, NetworkWritesARowForEachRate) {
  const std::vector<std::string> command = {"network",  "--pes", "4x4",    "--rate",   "0.1,0.3",
                                            "--cycles", "2000",  "--self", "--format", "csv"};
  const Outcome outcome = torolux(command);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "offered,accepted,mean_latency,p99_latency,max_latency,mean_hops,max_link_load,fairness");
  for (const std::string rate : {"0.1,", "0.3,"}) {
    std::getline(lines, line);
    EXPECT_THAT(line, testing::StartsWith(rate));
    EXPECT_EQ(std::ranges::count(line, ','), 7);
  }
  EXPECT_FALSE(std::getline(lines, line));
  EXPECT_EQ(torolux(command).out, outcome.out);
  EXPECT_THAT(torolux({"network", "--pes", "4x4", "--cycles", "2000"}).out, HasSubstr("  mean_latency"));
}

TEST(Main, NetworkRefusesAndFails) {
  const TemporaryFolder folder;
  const std::string machine = (folder.path() / "machine.toml").string();
  std::ofstream(machine) << "[torus]\nbubble = false\nbuffer_packets = 2\n";
  const Outcome deadlock = torolux({"network", "--pes", "1x8", "--rate", "1", "--machine", machine});
  EXPECT_EQ(deadlock.code, 3);
  EXPECT_THAT(deadlock.err, HasSubstr("deadlock at cycle"));
  EXPECT_EQ(torolux({"network", "--rate", "0"}).code, 2);
  EXPECT_EQ(torolux({"network", "--rate", "0.1,much"}).code, 1);
  EXPECT_EQ(torolux({"network", "--pes", "1x1"}).code, 2);
  EXPECT_EQ(torolux({"network", "--traffic", "rain"}).code, 1);
  EXPECT_EQ(torolux({"network", "--pes", "2x3", "--traffic", "transpose"}).code, 2);
  EXPECT_EQ(torolux({"network", "--fault", "link:0.6"}).code, 2);
  EXPECT_EQ(torolux({"network", "--fault", "bus:0.1"}).code, 1);
}

/// The exit code of a command whose standard output is this descriptor, which is closed.
int code_with_output(int descriptor, const std::vector<std::string>& arguments) {
  std::cout.flush();
  const int before = ::dup(STDOUT_FILENO);
  ::dup2(descriptor, STDOUT_FILENO);
  ::close(descriptor);
  std::vector<const char*> argv = {"torolux"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  const int code = torolux_main(static_cast<int>(argv.size()), argv.data());
  ::dup2(before, STDOUT_FILENO);
  ::close(before);
  std::cout.clear();
  return code;
}

// A table that nobody got is no success; and nothing more is computed for it.
TEST(Main, OutputThatIsLostIsAFailure) {
  const std::vector<std::string> network = {"network", "--pes", "2x2", "--cycles", "1000", "--format", "csv"};
  for (const std::vector<std::string>& arguments : {network, {"--help"}, {"--version"}}) {
    EXPECT_EQ(code_with_output(::open("/dev/full", O_WRONLY), arguments), 2) << arguments[0];
    EXPECT_EQ(code_with_output(::open("/dev/null", O_WRONLY), arguments), 0) << arguments[0];
  }
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  ::close(pipe[0]);
  // Hours, if it went on.
  EXPECT_EQ(code_with_output(pipe[1], {"network", "--rate", "0.9,0.9", "--cycles", "1000000000"}), 2);
}

TEST(Main, MissingSceneIsBadInput) {
  for (const char* command : {"render", "info"}) {
    const Outcome outcome = torolux({command, "/nowhere/scene"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("/nowhere/scene"));
  }
}

TEST(Main, OutputsAreCheckedBeforeTheWork) {
  const TemporaryFolder folder;
  const std::string scene = write_small_scene(folder.path()).string();
  EXPECT_EQ(torolux({"render", scene, "--output", "a.jpg"}).code, 1);
  for (const char* option : {"--output", "--stats", "--save-radiosity"}) {
    const Outcome outcome =
        torolux({"render", scene, "--output", folder.path() / "good.png", option, folder.path() / "missing" / "a.png"});
    EXPECT_EQ(outcome.code, 2) << option;
    EXPECT_THAT(outcome.err, HasSubstr("missing/a.png"));
  }
  EXPECT_EQ(folder.files(), 2U) << "only the scene";
}

TEST(Main, MissingFirmwareIsBadInputAndSaysWhatToDo) {
  const TemporaryFolder folder;
  const std::string scene = write_small_scene(folder.path()).string();
  ::setenv("TOROLUX_FIRMWARE", folder.path().c_str(), 1);
  const Outcome outcome = torolux({"render", scene, "--output", folder.path() / "a.png"});
  ::unsetenv("TOROLUX_FIRMWARE");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("pe.elf"));
  EXPECT_THAT(outcome.err, HasSubstr("TOROLUX_FIRMWARE"));
}

TEST(Main, CompareTellsTheDifferenceAndWritesIt) {
  const TemporaryFolder folder;
  write_picture({2, 1, {{1, 1, 1}, {2, 2, 2}}}, folder.path() / "a.pfm");
  write_picture({2, 1, {{1, 1, 1}, {2, 2, 4}}}, folder.path() / "b.exr");
  const Outcome outcome = torolux(
      {"compare", folder.path() / "a.pfm", folder.path() / "b.exr", "--output", folder.path() / "difference.pfm"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("(B of pixel 1, 0)"));
  const Picture difference = read_picture(folder.path() / "difference.pfm");
  EXPECT_EQ(difference.pixels[1], (std::array<float, 3>{0, 0, 2}));
}

TEST(Main, CompareTellsWhatIsSeen) {
  const TemporaryFolder folder;
  write_picture({2, 2, {{1, 1, 1}, {2, 2, 2}, {1, 1, 1}, {2, 2, 2}}}, folder.path() / "a.pfm");
  write_picture({2, 2, {{1, 1, 1}, {2, 2, 2}, {1, 1, 1}, {2, 2, 4}}}, folder.path() / "b.pfm");
  const auto compared = [&](const std::filesystem::path& other, const std::string& distance) {
    return torolux({"compare", folder.path() / "a.pfm", other, "--flip-map", folder.path() / "map.exr",
                    "--pixels-per-degree", distance});
  };
  const Outcome different = compared(folder.path() / "b.pfm", "67");
  EXPECT_EQ(different.code, 0) << different.err;
  EXPECT_THAT(different.out, HasSubstr("HDR-FLIP"));
  EXPECT_THAT(different.out, HasSubstr("streaks [L*]"));
  EXPECT_GT(read_picture(folder.path() / "map.exr").pixels[3][0], 0.05);
  EXPECT_EQ(compared(folder.path() / "a.pfm", "67").code, 0);
  EXPECT_EQ(read_picture(folder.path() / "map.exr").pixels[3][0], 0);
  EXPECT_EQ(compared(folder.path() / "b.pfm", "0").code, 1);
}

TEST(Main, CompareRefusesOtherSizes) {
  const TemporaryFolder folder;
  write_picture({2, 1, {{1, 1, 1}, {2, 2, 2}}}, folder.path() / "a.pfm");
  write_picture({1, 1, {{1, 1, 1}}}, folder.path() / "b.pfm");
  EXPECT_EQ(torolux({"compare", folder.path() / "a.pfm", folder.path() / "b.pfm"}).code, 2);
  EXPECT_EQ(torolux({"compare", folder.path() / "a.pfm", folder.path() / "a.pfm", "--output", "x.gif"}).code, 1);
}

// The same bytes that render would have written.
TEST(Main, TonemapMakesAPngOfRadiance) {
  const TemporaryFolder folder;
  const Picture picture{2, 1, {{1, 0.5F, 0.25F}, {2, 2, 40}}};
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  const auto bytes = [&](const char* name) { return read_file(file(name), 1U << 20U); };
  for (const char* name : {"a.exr", "a.pfm"}) {
    write_picture(picture, file(name));
    ASSERT_EQ(torolux({"tonemap", file(name), file("plain.png")}).code, 0) << name;
    write_picture(picture, file("wanted.png"));
    EXPECT_EQ(bytes("plain.png"), bytes("wanted.png"));
    ASSERT_EQ(torolux({"tonemap", file(name), file("set.png"), "--exposure", "-1.5", "--tone-curve", "linear"}).code,
              0);
    write_picture(picture, file("wanted.png"), {-1.5, ToneCurve::linear});
    EXPECT_EQ(bytes("set.png"), bytes("wanted.png"));
    EXPECT_NE(bytes("set.png"), bytes("plain.png"));
  }
}

TEST(Main, TonemapTellsOfPixelsThatAreNoNumbers) {
  const TemporaryFolder folder;
  const std::string picture = folder.path() / "a.pfm";
  constexpr float inf = std::numeric_limits<float>::infinity();
  write_picture({3, 1, {{1, 1, 1}, {inf, 1, 1}, {1, 1, std::nanf("")}}}, picture);
  const Outcome outcome = torolux({"tonemap", picture, folder.path() / "a.png"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("a.pfm: 2 of 3 pixels hold what is infinite or no number"));
}

TEST(Main, TonemapRefusesWhatItCannotReadOrWrite) {
  const TemporaryFolder folder;
  const std::string there = folder.path() / "a.exr";
  write_picture({1, 1, {{1, 1, 1}}}, there);
  const std::string png = folder.path() / "b.png";
  EXPECT_EQ(torolux({"tonemap", folder.path() / "none.exr", png}).code, 2);
  EXPECT_EQ(torolux({"tonemap", there, "/nowhere/b.png"}).code, 2);
  EXPECT_EQ(torolux({"tonemap", there, png, "--exposure", "99"}).code, 2);
  EXPECT_EQ(torolux({"tonemap", there, png}).code, 0);
  const Outcome again = torolux({"tonemap", png, folder.path() / "c.png"});
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err, HasSubstr("radiance"));
}

TEST(Interruption, SignalsSetTheFlagAndHandlersComeBack) {
  {
    const InterruptionGuard guard;
    EXPECT_FALSE(interrupted());
    ::raise(SIGTERM);
    EXPECT_TRUE(interrupted());
  }
  struct sigaction now {};
  ::sigaction(SIGTERM, nullptr, &now);
  EXPECT_EQ(now.sa_handler, SIG_DFL);
  const InterruptionGuard another;
  EXPECT_FALSE(interrupted()) << "a new command begins without it";
}

// Not every long computation looks at the flag.
TEST(Interruption, TheSecondSignalEndsTheProcess) {
  EXPECT_EXIT(
      {
        const InterruptionGuard guard;
        ::raise(SIGTERM);
        ::raise(SIGTERM);
        std::_Exit(0);
      },
      testing::KilledBySignal(SIGTERM), "");
}

TEST(Interruption, TheSecondSignalIsTheFirstWhereItComesByTwoWays) {
  const InterruptionGuard guard(SecondSignal::nothing);
  for (int times = 0; times < 3; ++times) ::raise(SIGTERM);
  EXPECT_TRUE(interrupted());
}

}  // namespace
}  // namespace torolux
