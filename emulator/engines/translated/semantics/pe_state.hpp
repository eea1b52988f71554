// SPDX-License-Identifier: MIT
// One PE of the translated engine: registers, clock and a view of local memory. Translated code and emulator share it.
// This folder's headers are also compiled into translated code, so they include nothing but the standard library.
#pragma once

#include <cstddef>
#include <cstdint>

namespace torolux::translated {

inline constexpr unsigned kPmpEntries = 16;
/// Address of local memory's first byte.
inline constexpr std::uint32_t kMemoryBase = 0x8000'0000U;

/// Called at every phase marker: immediate of the HINT, the PE's clock [cycles], its instructions so far.
using MarkerCall = void (*)(void* context, std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions);
/// Called at every other HINT that translated code meets; arguments as for a marker. True: it has happened, and what it
/// waited has been added to the PE's `cycles` (and to its limit): the code goes on. False: `run` stops, pc behind it.
using HintCall = bool (*)(void* context, std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions);

struct TranslatedPe {
  std::uint32_t x[32];  ///< x[0] stays 0
  std::uint32_t f[32];  ///< bits of binary32
  std::uint32_t pc;
  std::int32_t hint_immediate;  ///< of the HINT at which the PE stands

  std::uint64_t cycles;        ///< clock: set it after a HINT that waited
  std::uint64_t instructions;  ///< executed so far, phase markers not counted
  std::uint64_t cycle_limit;   ///< `run` stops soon after the clock has reached this

  std::byte* memory;           ///< local memory
  std::uint32_t memory_bytes;  ///< of local memory
  std::uint32_t load_limit;    ///< loads of up to 4 bytes at less than this, from kMemoryBase, need no closer look
  std::uint32_t store_limit;   ///< likewise stores, from the translation's store base

  // Between `run` and translated code.
  bool interpreted;     ///< from now on: its traps go where translated code has not foreseen it
  bool may_fetch;       ///< all code may be executed
  std::uint64_t slice;  ///< packed: translated code returns at a jump back or a call once it has counted so much

  MarkerCall marker;  ///< none: `run` stops at phase markers as at any HINT
  HintCall hint;      ///< none: `run` stops at every HINT
  void* context;      ///< of both

  // Control and status registers.
  std::uint32_t fflags, frm;
  std::uint32_t mstatus, mstatush, mtvec, mscratch, mepc, mcause, mtval, mie, mip;
  std::uint32_t pmpaddr[kPmpEntries];
  std::uint8_t pmpcfg[kPmpEntries];

  // lr.w: address and what stood there; sc.w succeeds if it stands there again.
  std::uint32_t reserved_address;  ///< kNoReservation: none
  std::uint32_t reserved_value;
};
static_assert(sizeof(TranslatedPe) <= 4096);

inline constexpr std::uint32_t kNoReservation = 0xFFFF'FFFFU;

/// Why translated code returned. An address says where to go on.
enum class Exit : std::uint32_t {
  ret,    ///< by `ret`. 0: who called it compares with the address it expects, alone
  jump,   ///< to a place outside the function
  hint,   ///< a HINT, already counted, at which the PE is to stop; the address is behind it
  look,   ///< the instruction there is for the interpreter; its block's cost from there on has been counted already
  slice,  ///< pe.slice cycles have been counted
};

/// Cycles and instructions of a stretch of code.
struct Cost {
  std::uint32_t cycles;
  std::uint32_t instructions;
};
/// Both in the one number that translated code counts in, which one short addition raises: instructions below, cycles
/// above. No instruction takes less than a cycle.
inline constexpr unsigned kInstructionBits = 23;
constexpr std::uint64_t pack(Cost cost) {
  return (static_cast<std::uint64_t>(cost.cycles) << kInstructionBits) | cost.instructions;
}
constexpr std::uint64_t cycles_in(std::uint64_t count) {
  return count >> kInstructionBits;
}
constexpr std::uint64_t instructions_in(std::uint64_t count) {
  return count & ((std::uint64_t{1} << kInstructionBits) - 1U);
}
/// The most cycles of a slice: its instructions, and what runs until the time is looked at, fit.
inline constexpr std::uint32_t kMostSlice = 1U << 20U;

/// How translated code returns.
struct Left {
  std::uint64_t count;  ///< packed Cost that it has counted
  std::uint64_t at;     ///< lower half: address; upper half: Exit
};

/// Most calls inside each other; a program that calls deeper goes on from `run`, so the host's stack suffices.
inline constexpr std::uint32_t kDeepest = 256;

/// A function of the program. count: what is counted already; at: where to begin; depth: of the call.
using HostFunction = Left (*)(TranslatedPe* pe, std::uint64_t count, std::uint64_t at, std::uint32_t depth);
/// Calls one at pe->pc, with nothing counted.
using EnterFunction = Left (*)(TranslatedPe* pe, HostFunction function);

}  // namespace torolux::translated
