// SPDX-License-Identifier: MIT
// Proves: PEs of two engines in one machine, and PEs that a debugger halts, steps and watches, take the same cycles,
// do the same and count the same as those of one engine that nobody looks at.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <thread>

#include "emulator/engines/image/image.hpp"
#include "tests/machine/gdb_client.hpp"
#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using testing_support::TemporaryFolder;
using Arguments = std::vector<std::string>;

std::string image(const std::string& name) {
  return (std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (name + ".elf")).string();
}

Arguments joined(Arguments first, const Arguments& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::string hexadecimal(std::uint32_t value) {
  std::ostringstream text;
  text << std::hex << value;
  return text.str();
}

// ---- Both engines in one machine ----

class Mixed : public testing::TestWithParam<const char*> {};

TEST_P(Mixed, PesOfBothEnginesTakeTheSameCycles) {
  const TemporaryFolder folder;
  const auto result_of = [&](const Arguments& more) {
    const std::string stats = folder.path() / "stats.json";
    const Finished run = run_torolux(joined({"run", image(GetParam()), "--pes", "3x4", "--stats", stats}, more));
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return run.output + statistics(stats).dump();
  };
  const std::string qemu = result_of({"--engine", "qemu"});
  EXPECT_EQ(result_of({"--engine", "translated"}), qemu);
  const std::vector<Arguments> mixtures = {
      {"--qemu-pes", "3,7"}, {"--qemu-pes", "0-3", "--qemu-pes", "11"}, {"--qemu-pes", "0-11"}};
  for (const Arguments& mixture : mixtures) {
    for (const char* threads : {"1", "2", "3"}) {
      EXPECT_EQ(result_of(joined(mixture, {"--threads", threads})), qemu) << mixture[1] << ", " << threads;
    }
  }
  EXPECT_EQ(result_of({"--engine", "qemu", "--qemu-pes", "2"}), qemu);
}
INSTANTIATE_TEST_SUITE_P(Images, Mixed, testing::Values("hello", "token"));

TEST(MixedEngines, OnlyTheNamedPesAreProcesses) {
  // Ten PEs in endless loops: see tests/images/faults.cpp.
  ToroluxProcess run({"run", image("faults"), "--pes", "1x10", "--qemu-pes", "3,7"});
  const std::vector<pid_t> qemus = run.children(2);
  ASSERT_EQ(qemus.size(), 2U);
  EXPECT_EQ(kill(qemus[1], SIGKILL), 0);
  const Finished end = run.wait();
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_THAT(end.errors, HasSubstr("PE 7: its QEMU process was killed by signal 9"));
  EXPECT_TRUE(all_gone(qemus));
}

TEST(MixedEngines, ARenderIsTheSame) {
  const TemporaryFolder folder;
  const auto render = [&](const std::string& name, const Arguments& more) {
    const Arguments render_scene =
        joined({"render", std::string(TOROLUX_SOURCE_DIR) + "/scenes/cornell_box"}, small_render_options());
    const Finished run = run_torolux(joined(joined(render_scene, {"--output", folder.path() / (name + ".pfm"),
                                                                  "--stats", folder.path() / (name + ".json")}),
                                            more));
    EXPECT_EQ(run.exit_code, 0) << run.errors;
  };
  render("one", {});
  for (const char* pes : {"2", "0,3"}) {
    render("mixed", {"--qemu-pes", pes});
    EXPECT_EQ(contents(folder.path() / "mixed.pfm"), contents(folder.path() / "one.pfm")) << pes;
    EXPECT_EQ(statistics(folder.path() / "mixed.json"), statistics(folder.path() / "one.json")) << pes;
  }
}

TEST(MixedEngines, WhatTheMachineDoesNotHaveIsRefused) {
  const auto expect = [](const Arguments& options, int exit_code, const std::string& text) {
    const Finished run = run_torolux(joined({"run", image("token"), "--pes", "4x4"}, options));
    EXPECT_EQ(run.exit_code, exit_code) << text;
    EXPECT_THAT(run.errors, HasSubstr(text));
  };
  expect({"--qemu-pes", "16"}, 2, "there is no PE 16 to run on QEMU; the machine has 0 to 15");
  expect({"--gdb", "16:0"}, 2, "there is no PE 16 to run on QEMU; the machine has 0 to 15");
  expect({"--gdb", "3:0", "--gdb", "3:0"}, 1, "PE 3 is to have two debuggers");
  expect({"--gdb", "3:65536"}, 2, "--gdb: \"3:65536\" is out of range: 0 to 65535 are allowed");
  expect({"--gdb", "x"}, 1, "--gdb: \"x\" is not a TCP port like 1234, or a path");
  expect({"--gdb", "x:1"}, 1, "--gdb: \"x\" is not a PE and a TCP port like 3:1234, or a path");
  expect({"--gdb", "0", "--gdb", "0"}, 1, "--gdb: given twice: one debugger holds all PEs");
  expect({"--gdb", "70000"}, 2, "--gdb: \"70000\" is out of range: 0 to 65535 are allowed");
  expect({"--gdb-pes", "3"}, 1, "--gdb-pes names PEs for --gdb PORT, which is not there");
  expect({"--gdb", "0", "--gdb-pes", "16"}, 2, "--gdb-pes: there is no PE 16; the machine has 0 to 15");
  expect({"--gdb", "0", "--gdb-pes", "3", "--qemu-pes", "3"}, 1, "PE 3 cannot both run on QEMU and be held");
  expect({"--gdb", "0", "--engine", "qemu"}, 1, "the engine qemu lends no PEs to the emulator's own debugger");
}

TEST(Timeout, HoldsWhileADebuggerIsAwaited) {
  const Finished run = run_torolux({"run", image("token"), "--pes", "2x1", "--gdb", "0", "--timeout", "1"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.errors, HasSubstr("the run has taken 1 s, and is given up (--timeout) while its PEs are held"));
}

// ---- Debuggers ----

/// The image `token`, with debuggers for some of its PEs.
class Debugged : public testing::Test {
 protected:
  void start(const std::vector<unsigned>& pes, const Arguments& more = {}) {
    Arguments arguments = joined({"run", image("token"), "--pes", "4x4", "--stats", stats("debugged")}, more);
    for (const unsigned pe : pes) arguments = joined(arguments, {"--gdb", std::to_string(pe) + ":0"});
    run_.emplace(arguments);
    for (const unsigned pe : pes) ports_.push_back(await_port(pe));
  }

  /// The run has ended as one that nobody looked at.
  void expect_undisturbed() {
    const Finished debugged = run_->wait();
    EXPECT_EQ(debugged.exit_code, 0) << debugged.errors;
    const Finished plain = run_torolux({"run", image("token"), "--pes", "4x4", "--stats", stats("plain")});
    EXPECT_EQ(debugged.output, plain.output);
    EXPECT_EQ(statistics(stats("debugged")), statistics(stats("plain")));
  }

  std::string stats(const std::string& name) const { return folder_.path() / (name + ".json"); }

  std::uint16_t await_port(unsigned pe) const {
    const std::smatch match = await_line("PE " + std::to_string(pe) + " is halted.*\n.*127\\.0\\.0\\.1:([0-9]+)");
    return match.empty() ? std::uint16_t{0} : static_cast<std::uint16_t>(std::stoul(match[1]));
  }

  /// Waits until the run has written what matches.
  std::smatch await_line(const std::string& expression) const {
    const std::regex line(expression);
    for (int tries = 0; tries < 1000; ++tries) {
      errors_ = run_->errors_so_far();
      std::smatch match;
      if (std::regex_search(errors_, match, line)) return match;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "no " << expression << ": " << errors_;
    return {};
  }

  static std::uint32_t address_of(const std::string& part_of_name, const std::string& image_name = "token") {
    const Image held = load_image(image(image_name));
    for (const ImageSymbol& symbol : held.symbols) {
      if (symbol.function && symbol.name.find(part_of_name) != std::string::npos) return symbol.address;
    }
    ADD_FAILURE() << "no function " << part_of_name;
    return 0;
  }

  TemporaryFolder folder_;
  std::optional<ToroluxProcess> run_;
  mutable std::string errors_;  // that the last match points into
  std::vector<std::uint16_t> ports_;
};

TEST_F(Debugged, BreakpointsStepsAndWatchpointsChangeNothing) {
  start({5});
  GdbClient gdb(ports_[0]);
  EXPECT_THAT(gdb.ask("?").value_or(""), StartsWith("T05"));
  const std::string place = hexadecimal(address_of("pe_main"));
  EXPECT_EQ(gdb.ask("Z0," + place + ",2"), "OK");
  EXPECT_THAT(gdb.ask("c").value_or(""), StartsWith("T05"));
  auto registers = gdb.registers();
  EXPECT_EQ(hexadecimal(registers[32]), place);
  EXPECT_EQ(gdb.ask("z0," + place + ",2"), "OK");
  const std::uint32_t stack = registers[2];
  for (int step = 0; step < 5; ++step) {
    EXPECT_THAT(gdb.ask("s").value_or(""), StartsWith("T05"));
    EXPECT_NE(gdb.pc(), registers[32]) << step;
    registers = gdb.registers();
  }
  EXPECT_EQ(gdb.ask("m" + hexadecimal(stack - 16) + ",10").value_or("").size(), 32U);
  // Return addresses are saved below the stack pointer: QEMU leaves each block that stores one in the middle.
  EXPECT_EQ(gdb.ask("Z2," + hexadecimal(stack - 4) + ",4"), "OK");
  for (int hit = 0; hit < 3; ++hit) EXPECT_THAT(gdb.ask("c").value_or(""), HasSubstr("watch:")) << hit;
  EXPECT_EQ(gdb.ask("z2," + hexadecimal(stack - 4) + ",4"), "OK");
  gdb.send("c");
  expect_undisturbed();
}

TEST_F(Debugged, EveryInstructionSteppedCountsOnce) {
  start({0}, {"--threads", "1"});
  GdbClient gdb(ports_[0]);
  // All of PE 0 that is not waiting, from QEMU's boot code to the end of the token's way.
  std::size_t steps = 0;
  for (; steps < 120; ++steps) ASSERT_THAT(gdb.ask("s").value_or(""), StartsWith("T05")) << steps;
  EXPECT_GE(gdb.pc(), 0x8000'0000U);
  gdb.send("c");
  expect_undisturbed();
}

TEST_F(Debugged, OneThatWaitsForAnotherCanBeInterrupted) {
  start({3, 5});
  GdbClient held(ports_[0]);
  GdbClient waiting(ports_[1]);
  // It waits for the token, which PE 3 does not pass on. On a busy computer it may not have begun when interrupted.
  for (int tries = 0; tries < 50; ++tries) {
    waiting.send("c");
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    waiting.interrupt();
    EXPECT_THAT(waiting.reply().value_or(""), StartsWith("T02"));
    if (waiting.pc() >= 0x8000'0000U) break;
  }
  EXPECT_GE(waiting.pc(), 0x8000'0000U);
  for (int step = 0; step < 3; ++step) EXPECT_THAT(waiting.ask("s").value_or(""), StartsWith("T05"));
  waiting.send("c");
  held.send("c");
  expect_undisturbed();
}

TEST_F(Debugged, CtrlCEndsAll) {
  start({3, 5});
  const GdbClient gdb(ports_[0]);
  const std::vector<pid_t> qemus = run_->children(2);
  run_->signal(SIGINT);
  EXPECT_EQ(run_->wait().exit_code, 130);
  EXPECT_TRUE(all_gone(qemus));
}

TEST_F(Debugged, OneDebuggerHoldsPesOfTheTranslatedEngine) {
  start({}, {"--gdb", "0", "--gdb-pes", "0,3-5"});
  const std::smatch match = await_line("the PEs are held.*\n.*127\\.0\\.0\\.1:([0-9]+)");
  ASSERT_FALSE(match.empty());
  GdbClient gdb(static_cast<std::uint16_t>(std::stoul(match[1])));
  EXPECT_EQ(gdb.ask("qfThreadInfo"), "mp1.1,p4.1,p5.1,p6.1");
  EXPECT_EQ(gdb.ask("Hgp5.1"), "OK");
  EXPECT_EQ(gdb.ask("Z0," + hexadecimal(address_of("pe_main")) + ",2"), "OK");
  EXPECT_THAT(gdb.ask("vCont;c").value_or(""), StartsWith("T05thread:p5.1;"));
  EXPECT_EQ(gdb.pc(), address_of("pe_main"));
  EXPECT_EQ(gdb.ask("Hcp5.1"), "OK");
  EXPECT_EQ(gdb.ask("bs"), "T05thread:p5.1;");
  EXPECT_NE(gdb.pc(), address_of("pe_main"));
  EXPECT_EQ(gdb.ask("D"), "OK");
  expect_undisturbed();
}

TEST_F(Debugged, ARenderIsHeldToo) {
  const Arguments scene =
      joined({"render", std::string(TOROLUX_SOURCE_DIR) + "/scenes/cornell_box"}, small_render_options());
  const auto written = [&](const std::string& name) {
    return Arguments{"--output", folder_.path() / (name + ".pfm"), "--stats", stats(name)};
  };
  run_.emplace(joined(joined(scene, written("held")), {"--gdb", "0", "--gdb-pes", "2"}));
  const std::smatch match = await_line("the PEs are held.*\n.*127\\.0\\.0\\.1:([0-9]+)");
  ASSERT_FALSE(match.empty());
  GdbClient gdb(static_cast<std::uint16_t>(std::stoul(match[1])));
  std::optional<std::string> reply = gdb.ask("vCont;s:p3.1");
  for (int tries = 0; !reply && tries < 10; ++tries) reply = gdb.reply();  // the scene is prepared first
  EXPECT_EQ(reply, "T05thread:p3.1;");
  EXPECT_EQ(gdb.ask("bs"), "E01");
  EXPECT_EQ(gdb.ask("D"), "OK");
  const Finished held = run_->wait();
  EXPECT_EQ(held.exit_code, 0) << held.errors;
  EXPECT_EQ(run_torolux(joined(scene, written("plain"))).exit_code, 0);
  EXPECT_EQ(contents(folder_.path() / "held.pfm"), contents(folder_.path() / "plain.pfm"));
  EXPECT_EQ(statistics(stats("held")), statistics(stats("plain")));
}

// So many steps that the machine was saved several times; the host's program and its files are part of what comes back.
TEST_F(Debugged, ALongRunGoesBackToItsSavedStates) {
  const auto heat = [&](const std::string& name, const Arguments& more) {
    return joined(joined({"run", image("heat"), "--pes", "4x2", "--engine", "interpreted", "--stats", stats(name),
                          "--output", "plate.ppm=" + (folder_.path() / (name + ".ppm")).string()},
                         more),
                  {"--", "64", "30"});
  };
  run_.emplace(heat("debugged", {"--gdb", "0", "--gdb-pes", "0"}));
  const std::smatch match = await_line("the PEs are held.*\n.*127\\.0\\.0\\.1:([0-9]+)");
  ASSERT_FALSE(match.empty());
  GdbClient gdb(static_cast<std::uint16_t>(std::stoul(match[1])));
  EXPECT_EQ(gdb.ask("Hgp1.1"), "OK");
  EXPECT_TRUE(gdb.ask("qSupported:multiprocess+;swbreak+"));
  const std::string breakpoint = "0," + hexadecimal(address_of("torolux_send", "heat")) + ",2";
  EXPECT_EQ(gdb.ask("Z" + breakpoint), "OK");
  const auto state = [&gdb] {
    return gdb.ask("g").value_or("") + gdb.ask("p46").value_or("") + gdb.ask("m80010000,400").value_or("");
  };
  constexpr int kStops = 40;  // two in a step of the plate, which takes some 15,000 instructions
  std::vector<std::string> states;
  for (int i = 0; i < kStops; ++i) {
    ASSERT_EQ(gdb.ask("vCont;c"), "T05thread:p1.1;swbreak:;") << i;
    states.push_back(state());
  }
  for (int i = kStops - 2; i >= kStops - 8; --i) {
    ASSERT_EQ(gdb.ask("bc"), "T05thread:p1.1;swbreak:;") << i;
    EXPECT_EQ(state(), states[static_cast<std::size_t>(i)]) << i;
  }
  EXPECT_EQ(gdb.ask("z" + breakpoint), "OK");
  EXPECT_EQ(gdb.ask("D"), "OK");
  const Finished debugged = run_->wait();
  const Finished plain = run_torolux(heat("plain", {}));
  EXPECT_EQ(debugged.output, plain.output);
  EXPECT_EQ(statistics(stats("debugged")), statistics(stats("plain")));
  EXPECT_EQ(contents(folder_.path() / "debugged.ppm"), contents(folder_.path() / "plain.ppm"));
}

TEST_F(Debugged, APortInUseIsRefused) {
  start({3});
  const std::string port = std::to_string(ports_[0]);
  const Finished second = run_torolux({"run", image("token"), "--gdb", "4:" + port});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.errors, HasSubstr("port " + port + " of 127.0.0.1: Address already in use"));
  GdbClient(ports_[0]).send("c");
  expect_undisturbed();
}

TEST_F(Debugged, ASocketOfAFolderIsForItsUserAlone) {
  const std::filesystem::path path = folder_.path() / "pe3";
  const mode_t before = umask(0);
  start({}, {"--gdb", "3:" + path.string()});
  umask(before);
  await_line("target remote " + path.string());
  struct stat status {};
  ASSERT_EQ(lstat(path.c_str(), &status), 0);
  EXPECT_TRUE(S_ISSOCK(status.st_mode));
  EXPECT_EQ(status.st_mode & 07777U, 0600U);
  const Finished second = run_torolux({"run", image("token"), "--gdb", "4:" + path.string()});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.errors, HasSubstr("pe3: Address already in use; take the path of a file that is not there yet"));
  GdbClient gdb(path);
  EXPECT_THAT(gdb.ask("?").value_or(""), StartsWith("T05"));
  gdb.send("c");
  expect_undisturbed();
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(Debugged, APeThatItsDebuggerKillsEndsTheRun) {
  start({3});
  GdbClient(ports_[0]).send("k");
  const Finished end = run_->wait();
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_THAT(end.errors, HasSubstr("PE 3: "));
}

}  // namespace
}  // namespace torolux::test
