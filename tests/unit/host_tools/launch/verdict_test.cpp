// SPDX-License-Identifier: MIT
// Proves: of all that ranks say and of how they end, the first that matters decides the exit code, and a lost rank is
// named with what became of it.
#include "host_tools/launch/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "emulator/errors.hpp"

namespace torolux::launch {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Kind = RankEvent::Kind;

// As waitpid has it.
constexpr int exited(int code) {
  return code << 8;
}

/// Three ranks, 100 + rank their processes.
Verdict begun(unsigned here = 3) {
  Verdict verdict(3);
  for (unsigned rank = 0; rank < here; ++rank) verdict.take({Kind::begins, rank, static_cast<pid_t>(100 + rank), 0});
  return verdict;
}

int code_of(const Verdict& verdict, int launcher = exited(0)) {
  return verdict.exit_code(launcher, {"mpirun", "-n", "3"});
}

std::string failure_of(const Verdict& verdict, int launcher = exited(0)) {
  try {
    code_of(verdict, launcher);
  } catch (const MachineFailure& failure) {
    return failure.what();
  }
  return "";
}

TEST(Verdict, IsRankZerosLastWord) {
  for (const int code : {0, 1, 2, 3, 77, 130}) {
    Verdict verdict = begun();
    EXPECT_FALSE(verdict.settled());
    verdict.take({Kind::ends, 0, 100, 0});
    EXPECT_TRUE(verdict.settled());
    verdict.take({Kind::ends, 0, 100, code});
    verdict.take({Kind::ends, 1, 101, 0});
    EXPECT_EQ(code_of(verdict, exited(1)), code) << "whatever the launcher says";
  }
}

TEST(Verdict, OthersCountOnlyWhereTheyFailFirst) {
  Verdict first = begun();
  first.take({Kind::ends, 1, 101, 0});
  EXPECT_FALSE(first.settled());
  first.take({Kind::ends, 2, 102, 3});
  first.take({Kind::ends, 0, 100, 130});  // the launcher has told it to end
  EXPECT_EQ(code_of(first), 3);
  EXPECT_TRUE(first.failed()) << "nothing is left to be written, and no launcher need be waited for";
  Verdict late = begun();
  late.take({Kind::ends, 0, 100, 0});
  late.take({Kind::ends, 1, 101, 3});
  EXPECT_EQ(code_of(late), 0);
}

TEST(Verdict, TheFirstRankThatDiesIsNamed) {
  Verdict verdict = begun();
  verdict.take({Kind::died, 1, 91, SIGSEGV});
  verdict.take({Kind::died, 0, 90, SIGKILL});
  verdict.take({Kind::keeper_gone, 0, 90, 0});
  verdict.take({Kind::ends, 2, 102, 130});
  EXPECT_TRUE(verdict.failed());
  EXPECT_THAT(failure_of(verdict),
              AllOf(HasSubstr("rank 1 ("), HasSubstr(", process 101) is lost: it died of signal 11"),
                    Not(HasSubstr("rank 0")), Not(HasSubstr("another computer"))));
}

TEST(Verdict, AKeeperThatIsKilledAndAnEndWithoutAWordAreLossesToo) {
  Verdict keeper = begun();
  keeper.take({Kind::keeper_gone, 2, 92, 0});
  EXPECT_THAT(failure_of(keeper), HasSubstr("process 102) is lost: its keeper was killed"));
  Verdict silent = begun();
  silent.take({Kind::died, 0, 90, exited(0)});
  EXPECT_THAT(failure_of(silent), HasSubstr("it ended with exit code 0 without a word"));
}

TEST(Verdict, WhoHasSaidItsEndIsNotLost) {
  Verdict verdict = begun();
  verdict.take({Kind::ends, 2, 102, 0});
  verdict.take({Kind::died, 2, 92, exited(0)});
  verdict.take({Kind::keeper_gone, 2, 92, 0});
  EXPECT_FALSE(verdict.failed());
  verdict.take({Kind::ends, 0, 100, 0});
  verdict.take({Kind::died, 1, 91, SIGKILL});  // the work is done
  EXPECT_EQ(code_of(verdict), 0);
}

TEST(Verdict, SaysWhereARankElsewhereMayHaveBeenTheFirst) {
  Verdict verdict = begun(2);
  verdict.take({Kind::died, 0, 90, SIGKILL});
  EXPECT_THAT(failure_of(verdict),
              HasSubstr("unless the launcher ended it because a rank on another computer was lost"));
}

TEST(Verdict, AnInterruptionIsOneUnlessSomethingWasBefore) {
  Verdict verdict = begun();
  verdict.interrupt();
  verdict.take({Kind::died, 0, 90, SIGKILL});
  EXPECT_THROW(code_of(verdict, SIGKILL), Interrupted);
  Verdict done = begun();
  done.take({Kind::ends, 0, 100, 0});
  done.interrupt();
  EXPECT_EQ(code_of(done), 0);
}

TEST(Verdict, WhoIsLostAfterAllWereToldToEndIsNoFailure) {
  Verdict verdict = begun();
  verdict.ask_to_end();
  verdict.take({Kind::died, 1, 91, SIGKILL});
  EXPECT_TRUE(verdict.failed()) << "no launcher need be waited for";
  EXPECT_THROW(code_of(verdict, SIGTERM), Interrupted);
  EXPECT_THAT(verdict.note(SIGTERM), AllOf(HasSubstr("rank 1 ("), HasSubstr("before rank 0 had ended")));
  Verdict in_order = begun();
  in_order.ask_to_end();
  in_order.take({Kind::ends, 0, 100, 130});
  in_order.take({Kind::died, 1, 91, SIGKILL});
  EXPECT_EQ(code_of(in_order), 130);
  EXPECT_EQ(in_order.note(SIGTERM), "");
  Verdict before = begun();
  before.take({Kind::died, 1, 91, SIGKILL});
  before.ask_to_end();
  EXPECT_THAT(failure_of(before), HasSubstr("rank 1 ("));
}

TEST(Verdict, ALauncherThatStartsNothingIsBlamed) {
  EXPECT_THAT(failure_of(Verdict(3), exited(1)), AllOf(HasSubstr("the launcher ended with exit code 1"),
                                                       HasSubstr("no rank has begun"), HasSubstr("mpirun -n 3")));
  EXPECT_THAT(failure_of(begun(), SIGKILL), AllOf(HasSubstr("signal 9"), HasSubstr("rank 0 has not said how it ends")));
  EXPECT_EQ(code_of(Verdict(3), exited(0)), 0) << "all are on other computers";
  EXPECT_THAT(Verdict(3).note(exited(0)), HasSubstr("no rank has begun on this computer"));
  EXPECT_EQ(Verdict(3).note(exited(1)), "");
  EXPECT_EQ(begun().note(exited(0)), "");
}

}  // namespace
}  // namespace torolux::launch
