// SPDX-License-Identifier: MIT
// What a PE's processor has besides computing: traps, control and status registers, memory protection.
// All as QEMU 7.2's `rv32` in machine mode alone; what QEMU has beyond docs/engines.md is an illegal instruction here.
#pragma once

#include <cstdint>
#include <optional>

#include "emulator/engines/translated/semantics/pe_state.hpp"

namespace torolux::translated {

/// mstatus.FS
inline constexpr std::uint32_t kFloatStatus = 3U << 13U;

/// Values of mcause.
enum class Cause : std::uint32_t {
  fetch_access = 1,
  illegal_instruction = 2,
  breakpoint = 3,
  load_misaligned = 4,
  load_access = 5,
  store_misaligned = 6,
  store_access = 7,
  machine_call = 11,
};

enum class Access : std::uint8_t { load = 1, store = 2, fetch = 4 };  ///< as in pmpcfg

/// The state in which `_start` begins, as QEMU's boot ROM leaves it. memory fields and marker are left alone.
void reset(TranslatedPe& pe);
/// Registers that the boot ROM has set; mapped_bytes: of QEMU's RAM.
void set_boot_registers(TranslatedPe& pe, std::size_t mapped_bytes);

/// Enters the trap handler.
void raise(TranslatedPe& pe, Cause cause, std::uint32_t value);
/// mret. False: the processor would leave machine mode, which it cannot.
bool return_from_trap(TranslatedPe& pe);

/// Nothing: there is no such register, or it is out of reach (floating point is off).
std::optional<std::uint32_t> read_csr(const TranslatedPe& pe, std::uint32_t number);
/// False: as above, or it is read-only.
bool write_csr(TranslatedPe& pe, std::uint32_t number, std::uint32_t value);
/// mstatus.FS is off: floating-point instructions are illegal.
inline bool float_is_off(const TranslatedPe& pe) {
  return (pe.mstatus & kFloatStatus) == 0;
}
/// An f register was written: mstatus.FS becomes "dirty".
void mark_float_dirty(TranslatedPe& pe);

/// Memory protection alone: whether bytes [address, address + bytes), on one page, may be accessed.
bool pmp_allows(const TranslatedPe& pe, std::uint32_t address, std::uint32_t bytes, Access access);
/// Bytes from `begin` on, up to `end`, that may be accessed without asking pmp_allows: 0 where the first may not.
std::uint32_t freely_accessible(const TranslatedPe& pe, std::uint32_t begin, std::uint32_t end, Access access);

}  // namespace torolux::translated
