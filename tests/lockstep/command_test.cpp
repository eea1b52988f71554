// SPDX-License-Identifier: MIT
// Proves: `torolux lockstep` takes images and scenes, and both engines agree in them; in a whole machine one wrong
// instruction of the PEs' own image is found.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <regex>

#include "emulator/engines/lockstep/lockstep_engine.hpp"
#include "emulator/errors.hpp"
#include "tests/machine/process.hpp"
#include "tests/support/render_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing_support::message_of;

std::string image(const std::string& name) {
  return (std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (name + ".elf")).string();
}

TEST(LockstepCommand, TheExampleImagesAgree) {
  for (const char* name : {"hello", "token"}) {
    for (const char* threads : {"1", "2"}) {
      const Finished run = run_torolux({"lockstep", image(name), "--pes", "3x2", "--threads", threads});
      EXPECT_EQ(run.exit_code, 0) << run.errors;
      EXPECT_THAT(run.output, HasSubstr("QEMU and the translated engine agree: "));
      EXPECT_THAT(run.output, HasSubstr("PE 0 @ ")) << "what the PEs say";
    }
  }
}

TEST(LockstepCommand, ARenderAgrees) {
  std::vector<std::string> arguments = small_render_options();
  arguments.insert(arguments.begin(), {"lockstep", (source_dir() / "scenes" / "cornell_spheres").string()});
  const Finished run = run_torolux(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output, ContainsRegex("agree: [0-9 ]+ HINTs and [0-9 ]+ phase markers at the same clocks"));
}

TEST(LockstepCommand, FaultsAreReportedAsOnAnyEngine) {
  const Finished trap = run_torolux({"lockstep", image("faults"), "--pes", "1x6"});  // see tests/images
  EXPECT_EQ(trap.exit_code, 3);
  EXPECT_THAT(trap.errors, HasSubstr("trap: illegal instruction at pc 0x"));
}

TEST(LockstepCommand, RefusesWhatMakesNoSense) {
  const Finished option = run_torolux({"lockstep", image("hello"), "--size", "16x16"});
  EXPECT_EQ(option.exit_code, 1);
  EXPECT_THAT(option.errors, HasSubstr("--size is for scenes, and this is a firmware image"));
  EXPECT_EQ(run_torolux({"lockstep", "/nowhere.elf"}).exit_code, 2);
  EXPECT_EQ(run_torolux({"lockstep"}).exit_code, 1);
}

/// Ten PEs in endless loops: see tests/images.
class EndlessLockstep : public testing::Test {
 protected:
  EndlessLockstep() : run_({"lockstep", image("faults"), "--pes", "1x10"}), qemus_(run_.children(10)) {}
  void SetUp() override { ASSERT_EQ(qemus_.size(), 10U); }

  ToroluxProcess run_;
  std::vector<pid_t> qemus_;
};

TEST_F(EndlessLockstep, CtrlCLeavesNothingBehind) {
  run_.signal(SIGINT);
  EXPECT_EQ(run_.wait().exit_code, 130);
  EXPECT_TRUE(all_gone(qemus_));
}

TEST_F(EndlessLockstep, AKilledQemuIsNamed) {
  ASSERT_EQ(kill(qemus_[7], SIGKILL), 0);
  const Finished end = run_.wait();
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_THAT(end.errors, HasSubstr("PE 7: its QEMU process was killed by signal 9"));
  EXPECT_TRUE(all_gone(qemus_));
}

/// pe.elf with the first fmul.s of a function turned into fadd.s.
Image altered_pe(const std::string& part_of_name) {
  Image altered = load_image(pe_image());
  for (const ImageSymbol& symbol : altered.symbols) {
    if (!symbol.function || symbol.name.find(part_of_name) == std::string::npos) continue;
    for (ImageSegment& segment : altered.segments) {
      if (symbol.address < segment.address || symbol.address - segment.address >= segment.contents.size()) continue;
      for (std::uint32_t offset = symbol.address - segment.address; offset + 4 <= segment.contents.size();) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &segment.contents[offset], 4);
        if ((bits & 0xFE00'007FU) == 0x1000'0053U) {  // fmul.s
          bits &= 0x01FF'FFFFU;                       // fadd.s
          std::memcpy(&segment.contents[offset], &bits, 4);
          return altered;
        }
        offset += (bits & 3U) == 3U ? 4 : 2;
      }
    }
  }
  ADD_FAILURE() << "pe.elf has no fmul.s behind " << part_of_name;
  return altered;
}

TEST(LockstepCommand, OneWrongInstructionOfARenderIsFound) {
  const Image altered = altered_pe("traverse");
  register_engine("lockstep-altered", [&altered](const EngineSetup& setup) {
    lockstep::Options options;
    options.other_image = &altered;
    return lockstep::make_engine(setup, options);
  });
  RenderCase render = native_case(source_dir() / "scenes" / "cornell_box");
  render.machine.engine = "lockstep-altered";
  render.machine.columns = render.machine.rows = 2;
  render.quality.width = render.quality.height = 8;
  render.quality.hemicube = 4;
  render.quality.max_shots = 2;
  const std::string report = message_of<MachineFailure>([&] { run_case(render); });
  EXPECT_THAT(report, ContainsRegex("PE [0-3]: QEMU and the translated engine part at its HINT [0-9]+: "));
  std::smatch row;
  ASSERT_TRUE(std::regex_search(report, row, std::regex("word +(0x[0-9a-f]+) +(0x[0-9a-f]+) +(0x[0-9a-f]+)")))
      << report;
  EXPECT_NE(row[1], row[2]) << "QEMU and translated";
  EXPECT_EQ(row[1], row[3]) << "QEMU and interpreted";
  EXPECT_THAT(report, ContainsRegex("From there translated:  to pc .*traverse"));
  EXPECT_THAT(report, ContainsRegex("since HINT [0-9]+ .clock [0-9]+.:(\n    clock [0-9]+ .*){30}$"));
}

}  // namespace
}  // namespace torolux::test
