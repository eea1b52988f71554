// SPDX-License-Identifier: MIT
// torolux.h: time. Enters: the processor's counters, which are the PE's clock on every engine; leaves: numbers.
#include <cstdint>

#include "firmware/kit/include/torolux.h"

namespace {

/// Both halves of the same moment.
template <class Low, class High>
std::uint64_t counter(Low low, High high) {
  for (;;) {
    const std::uint32_t before = high();
    const std::uint32_t value = low();
    if (high() == before) return (std::uint64_t{before} << 32U) | value;
  }
}

}  // namespace

std::uint64_t torolux_clock() {
  std::uint32_t value;  // NOLINT(cppcoreguidelines-init-variables): the instructions set it
  return counter(
      [&] {
        asm volatile("csrr %0, cycle" : "=r"(value));
        return value;
      },
      [&] {
        asm volatile("csrr %0, cycleh" : "=r"(value));
        return value;
      });
}

std::uint64_t torolux_instructions() {
  std::uint32_t value;  // NOLINT(cppcoreguidelines-init-variables): the instructions set it
  return counter(
      [&] {
        asm volatile("csrr %0, instret" : "=r"(value));
        return value;
      },
      [&] {
        asm volatile("csrr %0, instreth" : "=r"(value));
        return value;
      });
}
