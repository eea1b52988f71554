// SPDX-License-Identifier: MIT
// Proves: signals wait to be taken, and those that were ignored before are still.
#include "host_tools/launch/signal_file.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace torolux::launch {
namespace {

TEST(SignalFile, HasWhatHasCome) {
  const SignalFile signals;
  EXPECT_EQ(signals.take(), std::nullopt);
  ::raise(SIGTERM);
  EXPECT_EQ(signals.take(), SIGTERM);
  EXPECT_EQ(signals.take(), std::nullopt);
}

TEST(SignalFile, LeavesWhatNohupHadIgnored) {
  const auto before = ::signal(SIGHUP, SIG_IGN);
  {
    const SignalFile signals;
    ::raise(SIGHUP);
    EXPECT_EQ(signals.take(), std::nullopt);
    ::raise(SIGINT);
    EXPECT_EQ(signals.take(), SIGINT);
  }
  ::signal(SIGHUP, before);
}

}  // namespace
}  // namespace torolux::launch
