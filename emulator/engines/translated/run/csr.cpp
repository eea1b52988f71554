// SPDX-License-Identifier: MIT
// Traps, and the control and status registers.
#include "emulator/engines/translated/run/control.hpp"

namespace torolux::translated {
namespace {

// Fields of mstatus (RISC-V privileged architecture, 3.1.6).
constexpr std::uint32_t kMie = 1U << 3U;
constexpr std::uint32_t kMpie = 1U << 7U;
constexpr std::uint32_t kMpp = 3U << 11U;
constexpr std::uint32_t kFs = kFloatStatus;
constexpr std::uint32_t kVs = 3U << 9U;
constexpr std::uint32_t kSd = 1U << 31U;
constexpr std::uint32_t kGva = 1U << 6U, kMpv = 1U << 7U;  // of mstatush
/// What QEMU lets a program write: SIE, MIE, SPIE, MPIE, SPP, VS, MPP, FS, MPRV, SUM, MXR, TVM, TW, TSR.
constexpr std::uint32_t kWritableStatus = 0x007E'7FAAU;
constexpr std::uint32_t kInterrupts = 0x0000'2EEEU;      // mie
constexpr std::uint32_t kSoftInterrupts = 0x0000'2666U;  // mip, mideleg: those that a program may raise
constexpr std::uint32_t kTimerPending = 0x0000'0080U;    // QEMU's timer is due from the start
constexpr std::uint32_t kMisa = 0x4000'1125U;            // RV32, A C F I M

namespace number {
constexpr std::uint32_t kFflags = 0x001, kFrm = 0x002, kFcsr = 0x003;
constexpr std::uint32_t kMstatus = 0x300, kMisaNumber = 0x301, kMie = 0x304, kMtvec = 0x305, kMstatush = 0x310;
constexpr std::uint32_t kMscratch = 0x340, kMepc = 0x341, kMcause = 0x342, kMtval = 0x343, kMip = 0x344;
constexpr std::uint32_t kPmpcfg0 = 0x3A0, kPmpcfg3 = 0x3A3, kPmpaddr0 = 0x3B0, kPmpaddr15 = 0x3BF;
constexpr std::uint32_t kMcycle = 0xB00, kMinstret = 0xB02, kCycle = 0xC00, kTime = 0xC01, kInstret = 0xC02;
constexpr std::uint32_t kHighHalf = 0x80;  // added to each of these
constexpr std::uint32_t kMvendorid = 0xF11, kMhartid = 0xF14;
}  // namespace number

constexpr bool is_float_csr(std::uint32_t which) {
  return which >= number::kFflags && which <= number::kFcsr;
}
constexpr bool is_pmpcfg(std::uint32_t which) {
  return which >= number::kPmpcfg0 && which <= number::kPmpcfg3;
}
constexpr bool is_pmpaddr(std::uint32_t which) {
  return which >= number::kPmpaddr0 && which <= number::kPmpaddr15;
}

constexpr std::uint8_t kLocked = 0x80, kMatchField = 0x18, kTopOfRange = 0x08;

void write_pmpcfg(TranslatedPe& pe, std::uint32_t first, std::uint32_t value) {
  for (std::uint32_t i = 0; i < 4; ++i) {
    std::uint8_t& entry = pe.pmpcfg[first + i];
    if ((entry & kLocked) == 0) entry = static_cast<std::uint8_t>(value >> (8U * i));
  }
}

void write_pmpaddr(TranslatedPe& pe, std::uint32_t which, std::uint32_t value) {
  if (which + 1 < kPmpEntries) {
    const std::uint8_t next = pe.pmpcfg[which + 1];
    if ((next & kLocked) != 0 && (next & kMatchField) == kTopOfRange) return;
  }
  if ((pe.pmpcfg[which] & kLocked) == 0) pe.pmpaddr[which] = value;
}

std::uint32_t status(const TranslatedPe& pe) {
  const bool dirty = (pe.mstatus & kFs) == kFs || (pe.mstatus & kVs) == kVs;
  return pe.mstatus | (dirty ? kSd : 0);
}

void write_float_csr(TranslatedPe& pe, std::uint32_t which, std::uint32_t value) {
  pe.mstatus |= kFs;
  if (which == number::kFrm) {
    pe.frm = value & 7U;
    return;
  }
  pe.fflags = value & 31U;
  if (which == number::kFcsr) pe.frm = (value >> 5U) & 7U;
}

/// Where a plain register that can be written is kept, and which of its bits can.
struct Plain {
  std::uint32_t TranslatedPe::*place = nullptr;
  std::uint32_t mask = 0xFFFF'FFFFU;
};
Plain plain(std::uint32_t which) {
  switch (which) {
    case number::kMstatus:
      return {&TranslatedPe::mstatus, kWritableStatus};
    case number::kMstatush:
      return {&TranslatedPe::mstatush, kMpv | kGva};
    case number::kMie:
      return {&TranslatedPe::mie, kInterrupts};
    case number::kMscratch:
      return {&TranslatedPe::mscratch};
    case number::kMepc:
      return {&TranslatedPe::mepc};
    case number::kMcause:
      return {&TranslatedPe::mcause};
    case number::kMtval:
      return {&TranslatedPe::mtval};
    case number::kMip:
      return {&TranslatedPe::mip, kSoftInterrupts};
    case number::kMtvec:
      return {&TranslatedPe::mtvec};
    default:
      return {};
  }
}

}  // namespace

void reset(TranslatedPe& pe) {
  for (std::uint32_t i = 0; i < 32; ++i) pe.x[i] = pe.f[i] = 0;
  pe.pc = kMemoryBase;
  pe.hint_immediate = 0;
  pe.cycles = pe.instructions = 0;
  pe.fflags = pe.frm = 0;
  pe.mstatus = pe.mstatush = pe.mtvec = pe.mscratch = pe.mepc = pe.mcause = pe.mtval = pe.mie = 0;
  pe.mip = kTimerPending;
  for (unsigned i = 0; i < kPmpEntries; ++i) {
    pe.pmpaddr[i] = 0;
    pe.pmpcfg[i] = 0;
  }
  pe.reserved_address = kNoReservation;
  pe.reserved_value = 0;
}

void set_boot_registers(TranslatedPe& pe, std::size_t mapped_bytes) {
  // hw/riscv/boot.c: the device tree lies 1 MiB, 2 MiB-aligned, below the RAM's end; the ROM's last jump is by t0.
  constexpr std::uint32_t kRomAfterCode = 0x1028;
  constexpr std::size_t kTree = 1U << 20U;
  constexpr std::size_t kAlignment = 2U << 20U;
  pe.x[5] = kMemoryBase;
  pe.x[11] = kMemoryBase + static_cast<std::uint32_t>((mapped_bytes - kTree) / kAlignment * kAlignment);
  pe.x[12] = kRomAfterCode;
}

void raise(TranslatedPe& pe, Cause cause, std::uint32_t value) {
  const std::uint32_t was_enabled = (pe.mstatus & kMie) != 0 ? kMpie : 0;
  pe.mstatus = (pe.mstatus & ~(kMie | kMpie)) | was_enabled | kMpp;
  pe.mcause = static_cast<std::uint32_t>(cause);
  pe.mepc = pe.pc;
  pe.mtval = value;
  pe.pc = pe.mtvec & ~3U;
  pe.reserved_address = kNoReservation;
}

bool return_from_trap(TranslatedPe& pe) {
  if ((pe.mstatus & kMpp) != kMpp) return false;
  const std::uint32_t enabled = (pe.mstatus & kMpie) != 0 ? kMie : 0;
  pe.mstatus = (pe.mstatus & ~(kMie | kMpp)) | enabled | kMpie;
  pe.mstatush &= ~kMpv;
  pe.pc = pe.mepc;
  pe.reserved_address = kNoReservation;
  return true;
}

void mark_float_dirty(TranslatedPe& pe) {
  pe.mstatus |= kFs;
}

/// The PE's clock and its number of instructions, the reading one counted: not to be set.
std::optional<std::uint32_t> read_counter(const TranslatedPe& pe, std::uint32_t which) {
  const bool high = (which & number::kHighHalf) != 0;
  const auto half = [high](std::uint64_t value) { return static_cast<std::uint32_t>(high ? value >> 32U : value); };
  switch (which & ~number::kHighHalf) {
    case number::kMcycle:
    case number::kCycle:
    case number::kTime:
      return half(pe.cycles);
    case number::kMinstret:
    case number::kInstret:
      return half(pe.instructions);
    default:
      return std::nullopt;
  }
}

std::optional<std::uint32_t> read_csr(const TranslatedPe& pe, std::uint32_t which) {
  if (is_float_csr(which)) {
    if (float_is_off(pe)) return std::nullopt;
    if (which == number::kFflags) return pe.fflags;
    return which == number::kFrm ? pe.frm : (pe.frm << 5U) | pe.fflags;
  }
  if (is_pmpcfg(which)) {
    const std::uint8_t* entry = pe.pmpcfg + std::size_t{which - number::kPmpcfg0} * 4;
    return std::uint32_t{entry[0]} | (std::uint32_t{entry[1]} << 8U) | (std::uint32_t{entry[2]} << 16U) |
           (std::uint32_t{entry[3]} << 24U);
  }
  if (is_pmpaddr(which)) return pe.pmpaddr[which - number::kPmpaddr0];
  if (which == number::kMstatus) return status(pe);
  if (which == number::kMisaNumber) return kMisa;
  if (const auto counter = read_counter(pe, which)) return counter;
  if (which >= number::kMvendorid && which <= number::kMhartid) return 0;
  const Plain found = plain(which);
  return found.place != nullptr ? std::optional(pe.*found.place) : std::nullopt;
}

bool write_csr(TranslatedPe& pe, std::uint32_t which, std::uint32_t value) {
  constexpr std::uint32_t kReadOnly = 0xC00;
  if ((which & kReadOnly) == kReadOnly || !read_csr(pe, which) || read_counter(pe, which)) return false;
  if (is_float_csr(which)) {
    write_float_csr(pe, which, value);
  } else if (is_pmpcfg(which)) {
    write_pmpcfg(pe, (which - number::kPmpcfg0) * 4, value);
  } else if (is_pmpaddr(which)) {
    write_pmpaddr(pe, which - number::kPmpaddr0, value);
  } else if (const Plain found = plain(which); found.place != nullptr) {
    if (which == number::kMtvec && (value & 2U) != 0) return true;  // a reserved mode: ignored
    std::uint32_t& place = pe.*found.place;
    place = (place & ~found.mask) | (value & found.mask);
  }
  return true;
}

}  // namespace torolux::translated
