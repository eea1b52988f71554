// SPDX-License-Identifier: MIT
// How a program ends: well, or with words. Enters: what the C library and the program call; leaves: a halted PE, or the
// end of the run.
#include <cstddef>
#include <cstdlib>
#include <span>
#include <string_view>

#include "firmware/kit/include/torolux.h"
#include "firmware/kit/kit.hpp"
#include "firmware/protocol/host_services.hpp"

using torolux::kit::end_run;
using torolux::kit::Words;

extern "C" {

[[noreturn]] void _exit(int status) {
  using namespace torolux;
  if (status == 0) kit::messenger().end();
  if (const protocol::ExitStatus end{status}; status != 0) {
    kit::tell_host(protocol::MachineMessage::exit_status, std::as_bytes(std::span(&end, 1)));
  }
  kit::messenger().niu().halt();
}

[[noreturn]] void torolux_fail(const char* why) {
  end_run(Words() << (why != nullptr && *why != '\0' ? why : "torolux_fail"), TOROLUX_CALLER);
}

[[noreturn]] void abort() {
  end_run(Words() << "abort", TOROLUX_CALLER);
}

/// Of assert; and of the C library, where it has got no memory for a struct of its own.
[[noreturn]] void __assert_func(const char* file, int line, const char* function, const char* what) {
  if (std::string_view(what).ends_with("alloc succeeded")) torolux::kit::end_run_of_full_heap(TOROLUX_CALLER);
  Words words;
  words << "assertion \"" << what << "\" failed: " << file << ":" << line;
  if (function != nullptr) words << ", in " << function;
  end_run(words, TOROLUX_CALLER);
}

/// Of raise: there are no other processes.
int _kill(int /*process*/, int signal) {
  end_run(Words() << "signal " << signal, TOROLUX_CALLER);
}

int _getpid() {
  return static_cast<int>(torolux_pe()) + 1;
}

}  // extern "C"
