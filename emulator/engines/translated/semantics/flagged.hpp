// SPDX-License-Identifier: MIT
// Floating point of translated code whose program can see fflags: the host's own operations where its sticky flags mean
// the same, else the exact ones of soft_float.hpp. Results are canonical.
#pragma once

#include <cstdint>

#include "emulator/engines/translated/semantics/pe_state.hpp"
#include "emulator/engines/translated/semantics/soft_float.hpp"
#include "emulator/engines/translated/semantics/translated_code.hpp"

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace torolux::translated {

using soft::Rounding;

#if defined(__AVX__)
/// The host's sticky flags (MXCSR, Intel SDM volume 1, 10.2.3) while soft arithmetic, which raises them, too, runs.
class HostFlagsKept {
 public:
  HostFlagsKept() : control_(_mm_getcsr()) {}
  HostFlagsKept(const HostFlagsKept&) = delete;
  HostFlagsKept& operator=(const HostFlagsKept&) = delete;
  ~HostFlagsKept() { _mm_setcsr(control_); }

 private:
  unsigned control_;
};
inline void clear_host_flags() {
  constexpr unsigned kAllMaskedToNearest = 0x1F80;
  _mm_setcsr(kAllMaskedToNearest);
}
inline std::uint32_t host_flags() {
  const unsigned raised = _mm_getcsr();
  return ((raised & 0x20U) != 0 ? soft::kInexact : 0U) | ((raised & 0x10U) != 0 ? soft::kUnderflow : 0U) |
         ((raised & 0x08U) != 0 ? soft::kOverflow : 0U) | ((raised & 0x04U) != 0 ? soft::kDivideByZero : 0U) |
         ((raised & 0x01U) != 0 ? soft::kInvalid : 0U);
}
#else
struct HostFlagsKept {};
inline void clear_host_flags() {}
inline std::uint32_t host_flags() {
  return 0;
}
#endif

/// soft_float.hpp's operations on registers of translated code.
template <class Operation>
__attribute__((noinline)) float exactly(TranslatedPe* pe, Operation operation) {
  const HostFlagsKept kept;
  return from_bits(operation(pe->fflags));
}
template <class Operation>
__attribute__((noinline)) std::uint32_t exactly_integer(TranslatedPe* pe, Operation operation) {
  const HostFlagsKept kept;
  return operation(pe->fflags);
}

inline float flagged_fused(TranslatedPe* pe, float a, float b, float c) {
#if defined(__FMA__) && defined(__AVX__)
  float sum = a;
  asm volatile("vfmadd213ss %2, %1, %0" : "+x"(sum) : "x"(b), "x"(c));
  if (!TOROLUX_RARELY(sum != sum)) return sum;
#endif
  return exactly(pe, [=](std::uint32_t& flags) {
    return soft::fused(to_bits(a), to_bits(b), to_bits(c), Rounding::nearest_even, flags);
  });
}

#if defined(__AVX__)
// Volatile: kept in order, and kept even where nobody uses the result.
#define TOROLUX_FLAGGED(name, instruction)                                   \
  inline float flagged_##name(TranslatedPe*, float a, float b) {             \
    float result;                                                            \
    asm volatile(instruction " %2, %1, %0" : "=x"(result) : "x"(a), "x"(b)); \
    return canonical(result);                                                \
  }
TOROLUX_FLAGGED(add, "vaddss")
TOROLUX_FLAGGED(sub, "vsubss")
TOROLUX_FLAGGED(mul, "vmulss")
TOROLUX_FLAGGED(div, "vdivss")
#undef TOROLUX_FLAGGED

inline float flagged_sqrt(TranslatedPe*, float a) {
  float result;
  asm volatile("vsqrtss %1, %1, %0" : "=x"(result) : "x"(a));
  return canonical(result);
}
#else
#define TOROLUX_FLAGGED(name)                                                                                         \
  inline float flagged_##name(TranslatedPe* pe, float a, float b) {                                                   \
    return exactly(                                                                                                   \
        pe, [=](std::uint32_t& flags) { return soft::name(to_bits(a), to_bits(b), Rounding::nearest_even, flags); }); \
  }
TOROLUX_FLAGGED(add)
TOROLUX_FLAGGED(sub)
TOROLUX_FLAGGED(mul)
TOROLUX_FLAGGED(div)
#undef TOROLUX_FLAGGED

inline float flagged_sqrt(TranslatedPe* pe, float a) {
  return exactly(pe, [=](std::uint32_t& flags) { return soft::sqrt(to_bits(a), Rounding::nearest_even, flags); });
}
#endif

inline float flagged_extreme(TranslatedPe* pe, float a, float b, bool want_max) {
  return exactly(pe, [=](std::uint32_t& flags) { return soft::min_or_max(to_bits(a), to_bits(b), want_max, flags); });
}
inline float flagged_from_signed(TranslatedPe* pe, std::uint32_t a) {
  return exactly(pe, [=](std::uint32_t& flags) { return soft::from_signed(a, Rounding::nearest_even, flags); });
}
inline float flagged_from_unsigned(TranslatedPe* pe, std::uint32_t a) {
  return exactly(pe, [=](std::uint32_t& flags) { return soft::from_unsigned(a, Rounding::nearest_even, flags); });
}
inline std::uint32_t flagged_to_signed(TranslatedPe* pe, float a) {
  return exactly_integer(pe,
                         [=](std::uint32_t& flags) { return soft::to_signed(to_bits(a), Rounding::to_zero, flags); });
}
inline std::uint32_t flagged_to_unsigned(TranslatedPe* pe, float a) {
  return exactly_integer(pe,
                         [=](std::uint32_t& flags) { return soft::to_unsigned(to_bits(a), Rounding::to_zero, flags); });
}
inline std::uint32_t flagged_equal(TranslatedPe* pe, float a, float b) {
  return exactly_integer(pe, [=](std::uint32_t& flags) { return soft::equal(to_bits(a), to_bits(b), flags); });
}
inline std::uint32_t flagged_less(TranslatedPe* pe, float a, float b, bool or_equal) {
  return exactly_integer(pe, [=](std::uint32_t& flags) { return soft::less(to_bits(a), to_bits(b), or_equal, flags); });
}

}  // namespace torolux::translated
