// SPDX-License-Identifier: MIT
// Proves: gdb-multiarch, as users have it, works with the emulator's own debugger: processes by PE with their symbols,
// breakpoints, steps, watchpoints, registers, memory, and time that goes back; the run is then as if nobody had looked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>

#include "tests/machine/debugged_machine.hpp"

namespace torolux::test {
namespace {

using testing::ContainsRegex;

/// What gdb-multiarch says to these commands, one a line; errors too. From the checkout, where it finds the sources.
std::string gdb(const DebuggedMachine& machine, const testing_support::TemporaryFolder& folder,
                const std::string& commands) {
  const std::filesystem::path script = folder.path() / "script";
  std::ofstream(script) << "set pagination off\nset confirm off\nset debuginfod enabled off\ntarget remote "
                        << machine.socket().string() << "\nset schedule-multiple on\n"
                        << commands;
  const std::string command =
      "cd '" TOROLUX_SOURCE_DIR "' && timeout 40 gdb-multiarch -nx --batch -x " + script.string() + " 2>&1";
  std::FILE* const pipe = popen(command.c_str(), "r");
  std::string text;
  std::array<char, 4096> part{};
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe)) text.append(part.data(), count);
  EXPECT_EQ(pclose(pipe), 0) << text;
  return text;
}

class RealDebugger : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::system("gdb-multiarch --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "there is no gdb-multiarch";
  }
  DebuggedMachine::Options options(const std::string& image) const { return {image, GetParam(), {0, 1, 5}}; }
  testing_support::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Engines, RealDebugger, testing::Values("interpreted", "translated"));

TEST_P(RealDebugger, HoldsSeveralPesAndGoesBack) {
  DebuggedMachine machine(options("token"));
  const std::string said = gdb(machine, folder_, R"(info inferiors
info threads
break torolux::pe::pe_main
continue
info registers pc clock instructions
continue
continue
printf "here: "
info symbol $pc
x/2i $pc
p $sp
p $ft0
stepi
stepi
reverse-stepi
reverse-stepi
printf "back: "
info symbol $pc
finish
monitor pes
reverse-continue
printf "first: "
info symbol $pc
delete
monitor until 400
continue
monitor clock
continue
)");
  EXPECT_EQ(machine.wait(), plain_run(options("token"))) << said;
  for (const char* one :
       {"3    process 6 .*token\\.elf", "3\\.1 +Thread 6\\.1 \"PE 5\" \\(column 1, row 1\\) _start",
        "\"PE 0\" hit Breakpoint 1\\.[123], torolux::pe::pe_main .*\n.*set_slots", "\"PE 1\" hit Breakpoint 1\\.[123]",
        "\"PE 5\" hit Breakpoint 1\\.[123], torolux::pe::pe_main", "clock +0x31",
        "here: torolux::pe::pe_main.* in section", "=> 0x80000[0-9a-f]+ <_ZN7torolux2pe7pe_main",
        "\\(void \\*\\) 0x8000", "back: torolux::pe::pe_main.* in section", "PE 1: cycle [0-9]+, pc 0x8",
        "first: torolux::pe::pe_main.* in section", "PE [0-9]+: cycle [45][0-9][0-9],",
        "process [126]\\) exited normally"}) {
    EXPECT_THAT(said, ContainsRegex(one));
  }
}

TEST_P(RealDebugger, WatchpointsStopBothWays) {
  DebuggedMachine machine(options("token"));
  const std::string said = gdb(machine, folder_, R"(break torolux::pe::pe_main
continue
continue
continue
delete
set $place = (int *) ($sp - 4)
watch -l *$place
continue
p $pc
reverse-continue
reverse-continue
delete
continue
)");
  EXPECT_EQ(machine.wait(), plain_run(options("token"))) << said;
  EXPECT_THAT(said, ContainsRegex("Hardware watchpoint 2: "));
  EXPECT_THAT(said, ContainsRegex("Old value = .*\nNew value = .*"));
  EXPECT_THAT(said, ContainsRegex("No more reverse-execution history"));
  EXPECT_THAT(said, ContainsRegex("exited normally"));
}

}  // namespace
}  // namespace torolux::test
