// SPDX-License-Identifier: MIT
// Integer operations whose meaning C++ does not have: registers in, result out (RISC-V Instruction Set Manual, volume
// I, 20191213, chapter 7).
#pragma once

#include <cstdint>

namespace torolux::translated {

inline std::uint32_t shift_right_arithmetic(std::uint32_t a, std::uint32_t bits) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(a) >> (bits & 31U));
}
inline std::uint32_t less_signed(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::int32_t>(a) < static_cast<std::int32_t>(b) ? 1 : 0;
}
inline std::uint32_t mulh(std::uint32_t a, std::uint32_t b) {
  const std::int64_t product = std::int64_t{static_cast<std::int32_t>(a)} * static_cast<std::int32_t>(b);
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(product) >> 32U);
}
inline std::uint32_t mulhsu(std::uint32_t a, std::uint32_t b) {
  const std::int64_t product = std::int64_t{static_cast<std::int32_t>(a)} * static_cast<std::int64_t>(b);
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(product) >> 32U);
}
inline std::uint32_t mulhu(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>((std::uint64_t{a} * b) >> 32U);
}
inline std::uint32_t div(std::uint32_t a, std::uint32_t b) {
  if (b == 0) return 0xFFFF'FFFFU;
  if (b == 0xFFFF'FFFFU) return 0U - a;  // the one overflow, too
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(a) / static_cast<std::int32_t>(b));
}
inline std::uint32_t divu(std::uint32_t a, std::uint32_t b) {
  return b == 0 ? 0xFFFF'FFFFU : a / b;
}
inline std::uint32_t rem(std::uint32_t a, std::uint32_t b) {
  if (b == 0) return a;
  if (b == 0xFFFF'FFFFU) return 0;
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(a) % static_cast<std::int32_t>(b));
}
inline std::uint32_t remu(std::uint32_t a, std::uint32_t b) {
  return b == 0 ? a : a % b;
}

}  // namespace torolux::translated
