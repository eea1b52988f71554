// SPDX-License-Identifier: MIT
// What a thread does between two looks at something that another is about to change.
#pragma once

namespace torolux {

/// Tells the computer's core that this is a loop that waits, where it knows such an instruction.
inline void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace torolux
