// SPDX-License-Identifier: MIT
// The HINT on the PE itself: one literal 4-byte instruction, executed again while the NIU asks for it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/protocol/hints.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux::pe {

class HintGate {
 public:
  /// A HINT for which the NIU may let the processor wait. The NIU takes the repetitions off the PE's clock.
  /// The clobber is needed: the NIU reads and writes local memory meanwhile.
  template <std::int32_t kImmediate>
  void execute(protocol::NiuWindow& window) const {
    std::uint32_t again;  // NOLINT(cppcoreguidelines-init-variables): the instructions below set it
    asm volatile(
        "1: .4byte %[hint]\n"
        "lw %[again], %[retry](%[window])\n"
        "bnez %[again], 1b"
        : [again] "=&r"(again)
        : [hint] "i"(protocol::hint_instruction(kImmediate)), [retry] "i"(offsetof(protocol::NiuWindow, retry)),
          [window] "r"(&window)
        : "memory");
  }

  /// A HINT that never waits: the markers of the profile.
  template <std::int32_t kImmediate>
  void mark(protocol::NiuWindow& /*window*/) const {
    asm volatile(".4byte %[hint]" ::[hint] "i"(protocol::hint_instruction(kImmediate)) : "memory");
  }

  /// After Hint::halt or Hint::fail nothing may happen any more.
  [[noreturn]] void end() const {
    for (;;) asm volatile("");
  }
};

}  // namespace torolux::pe
