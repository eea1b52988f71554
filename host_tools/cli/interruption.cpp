// SPDX-License-Identifier: MIT
// Signals enter, a flag leaves.
#include "host_tools/cli/interruption.hpp"

#include "host_tools/cli/command.hpp"

namespace torolux {
namespace {

volatile std::sig_atomic_t flag = 0;

extern "C" void torolux_set_interrupted(int) {
  flag = 1;
}

}  // namespace

bool interrupted() {
  return flag != 0;
}

void forget_interruption() {
  flag = 0;
}

InterruptionGuard::InterruptionGuard(SecondSignal second) {
  flag = 0;
  const int once = second == SecondSignal::ends ? static_cast<int>(SA_RESETHAND) : 0;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction action {};
    const bool ends = kSignals[i] == SIGINT || kSignals[i] == SIGTERM || kSignals[i] == SIGHUP;
    action.sa_handler = ends ? &torolux_set_interrupted : SIG_IGN;
    sigemptyset(&action.sa_mask);
    action.sa_flags = ends ? SA_RESTART | once : SA_RESTART;
    ::sigaction(kSignals[i], &action, &before_[i]);
    // Started by nohup: leave it so.
    if (kSignals[i] == SIGHUP && before_[i].sa_handler == SIG_IGN) ::sigaction(kSignals[i], &before_[i], nullptr);
  }
}

InterruptionGuard::~InterruptionGuard() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
}

}  // namespace torolux
