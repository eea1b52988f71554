// SPDX-License-Identifier: MIT
// torolux.h: time. Enters: the processor's counters, which are the PE's clock on every engine; leaves: numbers.
#include <cstdint>

#include "firmware/kit/include/torolux.h"

namespace {

/// The processor's counters: numbers of their registers (RISC-V unprivileged architecture, Zicntr).
enum class Counter : std::uint16_t { cycle = 0xC00, cycleh = 0xC80, instret = 0xC02, instreth = 0xC82 };

template <Counter kCounter>
std::uint32_t read() {
  std::uint32_t value;  // NOLINT(cppcoreguidelines-init-variables): the instruction sets it
  asm volatile("csrr %0, %1" : "=r"(value) : "i"(kCounter));
  return value;
}

/// Both halves of the same moment.
template <Counter kLow, Counter kHigh>
std::uint64_t read() {
  for (;;) {
    const std::uint32_t before = read<kHigh>();
    const std::uint32_t value = read<kLow>();
    if (read<kHigh>() == before) return (std::uint64_t{before} << 32U) | value;
  }
}

}  // namespace

std::uint64_t torolux_clock() {
  return read<Counter::cycle, Counter::cycleh>();
}

std::uint64_t torolux_instructions() {
  return read<Counter::instret, Counter::instreth>();
}
