// SPDX-License-Identifier: MIT
// Proves: PEs that the emulator's own debugger holds, steps, watches and takes back in time do, say and count the same
// as those that nobody looks at; and that whatever a debugger sends is answered or refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/machine/debugged_machine.hpp"
#include "tests/machine/gdb_client.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string hexadecimal(std::uint64_t value) {
  std::ostringstream text;
  text << std::hex << value;
  return text.str();
}

std::string text_of(const std::string& digits) {
  std::string text;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    text += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  }
  return text;
}

std::string hex_text(const std::string& text) {
  std::string digits;
  for (const char c : text) digits += hexadecimal(static_cast<unsigned char>(c) | 0x100U).substr(1);
  return digits;
}

/// A debugger of one machine.
class Debugger {
 public:
  explicit Debugger(const DebuggedMachine& machine) : gdb_(machine.socket()) {
    features_ = ask("qSupported:multiprocess+;swbreak+");
    only_one_ = ask("qfThreadInfo").find(',') == std::string::npos;
  }
  std::string ask(const std::string& packet) { return gdb_.ask(packet).value_or("(nothing)"); }
  /// The next stop reply, console output left out.
  std::string stop_after(const std::string& packet) {
    std::string reply = ask(packet);
    while (reply.starts_with("O") && reply != "OK") {
      said_ += text_of(reply.substr(1));
      reply = gdb_.reply().value_or("(nothing)");
    }
    return reply;
  }
  std::string monitor(const std::string& command) { return text_of(ask("qRcmd," + hex_text(command))); }
  void choose(unsigned pe) { EXPECT_EQ(ask("Hgp" + hexadecimal(pe + 1) + ".1"), "OK"); }
  std::uint32_t pc(unsigned pe) {
    choose(pe);
    return gdb_.pc();
  }
  /// All that is seen of a PE.
  std::string state(unsigned pe, std::uint32_t memory) {
    choose(pe);
    std::string all = ask("g");
    for (unsigned number = 65; number < 79; ++number) all += ask("p" + hexadecimal(number));
    return all + ask("m" + hexadecimal(memory) + ",400");
  }
  void break_at(unsigned pe, std::uint32_t address) {
    choose(pe);
    EXPECT_EQ(ask("Z0," + hexadecimal(address) + ",2"), "OK");
  }
  const std::string& features() const { return features_; }
  const std::string& said() const { return said_; }
  GdbClient& client() { return gdb_; }
  /// All go on to the end of the run.
  void go_on_to_the_end() {
    const std::string reply = stop_after("vCont;c");
    EXPECT_THAT(reply, StartsWith("W00;process:"));
    if (only_one_) return;
    EXPECT_EQ(ask("D"), "OK");  // the others are still to be told of
  }

 private:
  GdbClient gdb_;
  std::string features_, said_;
  bool only_one_;
};

const std::vector<unsigned> kAll = {0, 1, 2, 3, 4, 5, 6, 7};

class Held : public testing::TestWithParam<const char*> {
 protected:
  DebuggedMachine::Options options(const std::string& image, const std::vector<unsigned>& held = kAll) const {
    return {image, GetParam(), held};
  }
};
INSTANTIATE_TEST_SUITE_P(Engines, Held, testing::Values("interpreted", "translated"));

TEST_P(Held, GoingOnIsAsIfNobodyLooked) {
  for (const char* image : {"hello", "token"}) {
    for (const std::vector<unsigned>& held : {kAll, std::vector<unsigned>{3}, std::vector<unsigned>{0, 5}}) {
      for (const unsigned threads : {1U, 3U}) {
        DebuggedMachine::Options with = options(image, held);
        with.threads = threads;
        DebuggedMachine machine(with);
        Debugger gdb(machine);
        gdb.go_on_to_the_end();
        EXPECT_EQ(machine.wait(), plain_run(with)) << image << ", " << held.size() << ", " << threads;
      }
    }
  }
}

TEST_P(Held, BreakpointsStepsAndWatchpointsChangeNothing) {
  DebuggedMachine machine(options("token"));
  Debugger gdb(machine);
  const std::uint32_t place = machine.address_of("pe_main");
  EXPECT_THAT(gdb.ask("?"), StartsWith("T05thread:p1.1;"));
  gdb.break_at(0, place);
  gdb.break_at(5, place);
  // Both come there in the same cycle: the lower number is told first.
  EXPECT_EQ(gdb.stop_after("vCont;c"), "T05thread:p1.1;swbreak:;");
  EXPECT_EQ(gdb.stop_after("vCont;c"), "T05thread:p6.1;swbreak:;");
  EXPECT_EQ(gdb.pc(5), place);
  const std::uint32_t stack = gdb.client().registers()[2];
  for (int i = 0; i < 5; ++i) {
    const std::uint32_t before = gdb.pc(5);
    EXPECT_EQ(gdb.stop_after("vCont;s:p6.1"), "T05thread:p6.1;");
    EXPECT_NE(gdb.pc(5), before);
  }
  EXPECT_EQ(gdb.ask("Z2," + hexadecimal(stack - 4) + ",4"), "OK");
  EXPECT_EQ(gdb.stop_after("vCont;c"), "T05thread:p6.1;watch:" + hexadecimal(stack - 4) + ";");
  EXPECT_EQ(gdb.ask("z2," + hexadecimal(stack - 4) + ",4"), "OK");
  gdb.go_on_to_the_end();
  EXPECT_EQ(machine.wait(), plain_run(options("token")));
}

TEST_P(Held, EveryInstructionSteppedCountsOnce) {
  DebuggedMachine machine(options("token", {0}));
  Debugger gdb(machine);
  for (int i = 0; i < 300; ++i) ASSERT_EQ(gdb.stop_after("vCont;s:p1.1"), "T05thread:p1.1;") << i;
  gdb.go_on_to_the_end();
  EXPECT_EQ(machine.wait(), plain_run(options("token", {0})));
}

TEST_P(Held, ArrivalsAreSeenByWatchpoints) {
  DebuggedMachine machine(options("token"));
  Debugger gdb(machine);
  gdb.break_at(3, machine.address_of("pe_main"));
  EXPECT_THAT(gdb.stop_after("vCont;c"), StartsWith("T05thread:p4.1;"));
  // NiuWindow::arrival is written by the NIU when the token comes.
  const std::uint32_t window = machine.image().niu_window;
  EXPECT_EQ(gdb.ask("Z2," + hexadecimal(window) + ",1000"), "OK");
  const std::string reply = gdb.stop_after("vCont;c");
  EXPECT_EQ(reply, "T05thread:p4.1;watch:" + hexadecimal(window) + ";");
  EXPECT_EQ(gdb.ask("z2," + hexadecimal(window) + ",1000"), "OK");
  gdb.go_on_to_the_end();
}

TEST_P(Held, WhoWaitsForOneThatIsHeldSaysSo) {
  DebuggedMachine machine(options("token"));
  Debugger gdb(machine);
  // PE 1 alone goes on: the token would come from PE 0.
  EXPECT_EQ(gdb.stop_after("vCont;c:p2.1"), "T05thread:p2.1;");
  EXPECT_THAT(gdb.said(), HasSubstr("PE 1 can go no further while other PEs are held"));
  EXPECT_THAT(gdb.monitor("pes"), HasSubstr("PE 1: cycle"));
  EXPECT_THAT(gdb.monitor("pes"), HasSubstr("waits in a HINT"));
  gdb.go_on_to_the_end();
  EXPECT_EQ(machine.wait(), plain_run(options("token")));
}

TEST_P(Held, MonitorTellsAndStopsAtACycle) {
  DebuggedMachine machine(options("hello"));
  Debugger gdb(machine);
  EXPECT_THAT(gdb.monitor("clock"), StartsWith("PE 0: cycle 0, 0 instructions"));
  EXPECT_THAT(gdb.monitor("until 100"), HasSubstr("cycle 100"));
  EXPECT_EQ(gdb.stop_after("vCont;c"), "T05thread:p1.1;");
  EXPECT_THAT(gdb.monitor("clock"), StartsWith("PE 0: cycle 100,"));
  EXPECT_THAT(gdb.monitor("until x"), HasSubstr("whole number"));
  EXPECT_THAT(gdb.monitor("what"), HasSubstr("monitor pes"));
  gdb.go_on_to_the_end();
}

// ---- Going back ----

TEST_P(Held, StepsBackLeadThroughTheSameStates) {
  DebuggedMachine machine(options("token"));
  Debugger gdb(machine);
  EXPECT_THAT(gdb.features(), HasSubstr("ReverseStep+;ReverseContinue+"));
  EXPECT_EQ(gdb.ask("Hcp1.1"), "OK");
  gdb.break_at(0, machine.address_of("pe_main"));
  EXPECT_THAT(gdb.stop_after("vCont;c"), StartsWith("T05thread:p1.1;"));
  const std::uint32_t memory = machine.image().niu_window;
  std::vector<std::string> states;
  for (int i = 0; i < 40; ++i) {
    states.push_back(gdb.state(0, memory));
    ASSERT_EQ(gdb.stop_after("vCont;s:p1.1;c"), "T05thread:p1.1;") << i;
  }
  for (int i = 39; i >= 0; i -= 13) {
    for (int steps = 0; steps < (i == 39 ? 1 : 13); ++steps) ASSERT_EQ(gdb.stop_after("bs"), "T05thread:p1.1;");
    EXPECT_EQ(gdb.state(0, memory), states[static_cast<std::size_t>(i)]) << i;
  }
  gdb.choose(0);
  EXPECT_EQ(gdb.ask("z0," + hexadecimal(machine.address_of("pe_main")) + ",2"), "OK");
  gdb.go_on_to_the_end();
  EXPECT_EQ(machine.wait(), plain_run(options("token")));
}

TEST_P(Held, GoingBackStopsAtTheLastBreakpoint) {
  DebuggedMachine machine(options("token"));
  Debugger gdb(machine);
  const std::uint32_t place = machine.address_of("pe_main");
  for (const unsigned pe : {2U, 5U}) gdb.break_at(pe, place);
  EXPECT_THAT(gdb.stop_after("vCont;c"), StartsWith("T05thread:p3.1;"));
  const std::string third = gdb.state(2, machine.image().niu_window);
  EXPECT_THAT(gdb.stop_after("vCont;c"), StartsWith("T05thread:p6.1;"));
  const std::string sixth = gdb.state(5, machine.image().niu_window);
  EXPECT_THAT(gdb.monitor("until 700"), HasSubstr("700"));
  EXPECT_THAT(gdb.stop_after("vCont;c"), StartsWith("T05thread:"));
  EXPECT_EQ(gdb.stop_after("bc"), "T05thread:p6.1;swbreak:;");
  EXPECT_EQ(gdb.state(5, machine.image().niu_window), sixth);
  EXPECT_EQ(gdb.stop_after("bc"), "T05thread:p3.1;swbreak:;");
  EXPECT_EQ(gdb.state(2, machine.image().niu_window), third);
  EXPECT_EQ(gdb.stop_after("bc"), "T05thread:p1.1;replaylog:begin;");
  EXPECT_EQ(gdb.pc(0), protocol::kLocalMemoryBase);
  EXPECT_EQ(gdb.stop_after("bs"), "T05thread:p1.1;replaylog:begin;");
  EXPECT_EQ(gdb.stop_after("vCont;c"), "T05thread:p3.1;swbreak:;");
  for (const unsigned pe : {2U, 5U}) {
    gdb.choose(pe);
    EXPECT_EQ(gdb.ask("z0," + hexadecimal(place) + ",2"), "OK");
  }
  gdb.go_on_to_the_end();
  EXPECT_EQ(machine.wait(), plain_run(options("token")));
}

TEST_P(Held, WhatHasBeenSaidIsNotSaidAgain) {
  DebuggedMachine machine(options("hello"));
  Debugger gdb(machine);
  EXPECT_THAT(gdb.monitor("until 2000"), HasSubstr("2000"));
  const std::string reply = gdb.stop_after("vCont;c");
  if (reply.starts_with("T05")) {
    EXPECT_THAT(gdb.stop_after("bc"), HasSubstr("replaylog:begin"));
  }
  gdb.go_on_to_the_end();
  EXPECT_EQ(machine.wait(), plain_run(options("hello")));
}

TEST_P(Held, ChangesAreMadeAgainWhenTimeIsRunAgain) {
  DebuggedMachine machine(options("token"));
  Debugger gdb(machine);
  gdb.break_at(0, machine.address_of("pe_main"));
  EXPECT_THAT(gdb.stop_after("vCont;c"), StartsWith("T05thread:p1.1;"));
  gdb.choose(0);
  EXPECT_EQ(gdb.ask("P1f=78563412"), "OK");  // t6
  const std::uint32_t free = machine.image().stores_begin + 0x4000;
  EXPECT_EQ(gdb.ask("M" + hexadecimal(free) + ",4:deadbeef"), "OK");
  for (int i = 0; i < 3; ++i) EXPECT_THAT(gdb.stop_after("vCont;s:p1.1;c"), StartsWith("T05"));
  EXPECT_EQ(gdb.ask("Hcp1.1"), "OK");
  EXPECT_EQ(gdb.stop_after("bs"), "T05thread:p1.1;");
  EXPECT_EQ(gdb.ask("p1f"), "78563412");
  EXPECT_EQ(gdb.ask("m" + hexadecimal(free) + ",4"), "deadbeef");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(gdb.stop_after("bs"), "T05thread:p1.1;");
  EXPECT_EQ(gdb.ask("m" + hexadecimal(free) + ",4"), "00000000") << "before the change";
  for (int i = 0; i < 3; ++i) gdb.stop_after("vCont;s:p1.1;c");
  EXPECT_EQ(gdb.ask("m" + hexadecimal(free) + ",4"), "deadbeef");
}

// ---- What is refused ----

TEST_P(Held, WhatCannotBeIsRefused) {
  DebuggedMachine machine(options("token", {3, 5}));
  Debugger gdb(machine);
  const std::string code = hexadecimal(machine.address_of("pe_main"));
  for (const std::string& packet :
       {std::string("Hgp1.1"), std::string("Hgp4.2"), std::string("m0,4"), std::string("p7f"), std::string("P0"),
        "M" + code + ",2:0000", "X" + code + ",2:ab", std::string("M80001000,4:00"), std::string("Tp9.1"),
        std::string("vCont;c:p1.1"), std::string("vCont;x"), std::string("vAttach;1"), std::string("D;1"),
        std::string("G00"), std::string("c80000000"), std::string("qXfer:features:read:target.xml:x")}) {
    EXPECT_EQ(gdb.ask(packet), "E01") << packet;
  }
  for (const char* unknown : {"Z9,0,0", "vMustReplyEmpty", "QNonStop:1", "R0", "qWhat", "~", ""}) {
    EXPECT_EQ(gdb.ask(unknown), "") << unknown;
  }
  EXPECT_EQ(gdb.ask("Tp4.1"), "OK");
  EXPECT_EQ(gdb.ask("qfThreadInfo"), "mp4.1,p6.1");
  EXPECT_EQ(gdb.ask("qC"), "QCp4.1");
  EXPECT_EQ(gdb.ask("qAttached:4"), "1");
  EXPECT_THAT(gdb.ask("qXfer:threads:read::0,ffff"), HasSubstr("PE 5"));
  EXPECT_THAT(gdb.ask("qXfer:exec-file:read:4:0,ffff"), HasSubstr("token.elf"));
  EXPECT_THAT(gdb.ask("qXfer:features:read:target.xml:0,20"), StartsWith("m<?xml"));
  EXPECT_EQ(gdb.ask("vAttach;6"), "T05thread:p6.1;");
  gdb.go_on_to_the_end();
  EXPECT_EQ(machine.wait(), plain_run(options("token")));
}

TEST_P(Held, HostilePacketsChangeNothing) {
  DebuggedMachine machine(options("token", {3, 5}));
  Debugger gdb(machine);
  std::mt19937 random(3);
  const std::string first = "?!HTgpmzqQvRrxtbBACFIiUwy";  // none that writes, goes on or ends
  const std::string then = "0123456789abcdefp.,:;-=#$}Contfread";
  for (int i = 0; i < 500; ++i) {
    std::string packet(1, first[random() % first.size()]);
    for (std::size_t length = random() % 20; length > 0; --length) packet += then[random() % then.size()];
    if (packet.find_first_of("#$}") != std::string::npos || packet.starts_with("vCont;")) continue;
    EXPECT_NE(gdb.ask(packet), "(nothing)") << packet;
  }
  gdb.go_on_to_the_end();
  EXPECT_EQ(machine.wait(), plain_run(options("token")));
}

TEST_P(Held, ADebuggerThatIsGoneHoldsNothing) {
  DebuggedMachine machine(options("token"));
  {
    Debugger gdb(machine);
    gdb.break_at(0, machine.address_of("pe_main"));
  }
  EXPECT_EQ(machine.wait(), plain_run(options("token")));
}

TEST_P(Held, KillEndsTheRun) {
  DebuggedMachine machine(options("token"));
  {
    Debugger gdb(machine);
    EXPECT_EQ(gdb.ask("vKill;1"), "OK");
  }
  EXPECT_EQ(machine.wait().failure, "the debugger has ended the run");
}

TEST_P(Held, AFailureStopsBeforeItHappens) {
  DebuggedMachine machine(options("faults", {0}));
  Debugger gdb(machine);
  const std::string reply = gdb.stop_after("vCont;c");
  EXPECT_THAT(reply, testing::AnyOf(StartsWith("T"), StartsWith("W03"))) << reply;
}

}  // namespace
}  // namespace torolux::test
