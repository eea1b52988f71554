// SPDX-License-Identifier: MIT
// The `torolux` executable: all of it is in torolux_main, so that tests can call it and add engines of their own.
#include <csignal>

#include "host_tools/cli/command.hpp"

namespace {

bool ignores_hangup = false;

/// What nohup has asked for, seen before libraries' constructors: UCX, which MPICH brings along, takes SIGHUP for
/// itself.
__attribute__((no_sanitize("address", "undefined"))) void look_at_hangup() {
  struct sigaction action {};
  ignores_hangup = ::sigaction(SIGHUP, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

[[gnu::section(".preinit_array"), gnu::used]] void (*before_constructors)() = &look_at_hangup;

}  // namespace

int main(int argc, char** argv) {
  if (ignores_hangup) std::signal(SIGHUP, SIG_IGN);
  return torolux::torolux_main(argc, argv);
}
