// SPDX-License-Identifier: MIT
// What the text of translated code is made of: it includes this header alone. The host rounds to nearest.
#pragma once

#include <cstdint>
#include <cstring>

#include "emulator/engines/translated/semantics/integer.hpp"
#include "emulator/engines/translated/semantics/pe_state.hpp"

// Labels as values, and addresses of them, are extensions of GCC and Clang.
#pragma GCC diagnostic ignored "-Wpedantic"

namespace torolux::translated {

#define TOROLUX_RARELY(condition) __builtin_expect(static_cast<bool>(condition), 0)

/// Why and where translated code leaves, in one number.
constexpr std::uint64_t left_for(Exit why, std::uint32_t at) {
  return static_cast<std::uint64_t>(why) << 32U | at;
}

inline float from_bits(std::uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
inline std::uint32_t to_bits(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// A result of the host's arithmetic as RISC-V has it: every NaN is the same.
inline float canonical(float value) {
  if (TOROLUX_RARELY(value != value)) {
    asm volatile("");  // keeps the compiler from replacing the branch, which costs nothing, by a selection
    return from_bits(0x7FC0'0000U);
  }
  return value;
}

/// memory: where address 0 would be. base + offset is in local memory: sums do not wrap.
template <class T>
inline T load_at(std::uintptr_t memory, std::uint32_t base, std::int64_t offset) {
  T value;
  std::memcpy(&value, reinterpret_cast<const void*>(memory + base + offset), sizeof value);
  return value;
}
template <class T>
inline void store_at(std::uintptr_t memory, std::uint32_t base, std::int64_t offset, T value) {
  std::memcpy(reinterpret_cast<void*>(memory + base + offset), &value, sizeof value);
}

inline float square_root(float a) {
  return __builtin_sqrtf(a);
}
inline float fused(float a, float b, float c) {
  return __builtin_fmaf(a, b, c);
}

inline float with_sign(float a, std::uint32_t sign) {
  return from_bits((to_bits(a) & 0x7FFF'FFFFU) | (sign & 0x8000'0000U));
}
inline float with_sign_of(float a, float b) {
  return with_sign(a, to_bits(b));
}
inline float with_other_sign(float a, float b) {
  return with_sign(a, ~to_bits(b));
}
inline float with_product_sign(float a, float b) {
  return from_bits(to_bits(a) ^ (to_bits(b) & 0x8000'0000U));
}

/// fmin.s and fmax.s where the operands are equal or not both numbers: zeros have an order, numbers win over NaN.
inline float extreme_of_odd(float a, float b, bool want_max) {
  if (a == b) return ((to_bits(a) >> 31U) != 0) != want_max ? a : b;
  if (a == a) return a;
  return b == b ? b : from_bits(0x7FC0'0000U);
}
inline float smaller(float a, float b) {
  if (a < b) return a;
  if (b < a) return b;
  return extreme_of_odd(a, b, false);
}
inline float larger(float a, float b) {
  if (a > b) return a;
  if (b > a) return b;
  return extreme_of_odd(a, b, true);
}

/// fcvt.w.s, fcvt.wu.s towards zero.
inline std::uint32_t to_signed(float a) {
  if (a > -2147483904.0F && a < 2147483648.0F) return static_cast<std::uint32_t>(static_cast<std::int32_t>(a));
  return a < 0 ? 0x8000'0000U : 0x7FFF'FFFFU;
}
inline std::uint32_t to_unsigned(float a) {
  if (a > -1.0F && a < 4294967296.0F) return static_cast<std::uint32_t>(static_cast<std::int64_t>(a));
  return a < 0 ? 0 : 0xFFFF'FFFFU;
}

/// A phase marker; count: what the code has counted up to it. False: the PE is to stop at it.
inline bool mark(TranslatedPe* pe, std::uint64_t count, std::int32_t immediate) {
  if (pe->marker == nullptr) return false;
  pe->marker(pe->context, immediate, pe->cycles + cycles_in(count), pe->instructions + instructions_in(count));
  return true;
}

/// Any other HINT, likewise. False: the PE is to stop behind it.
inline bool ask(TranslatedPe* pe, std::uint64_t count, std::int32_t immediate) {
  pe->hint_immediate = immediate;
  return pe->hint != nullptr &&
         pe->hint(pe->context, immediate, pe->cycles + cycles_in(count), pe->instructions + instructions_in(count));
}

}  // namespace torolux::translated
