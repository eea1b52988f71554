// SPDX-License-Identifier: MIT
// The one instruction by which processor and NIU meet: `slti x0, x0, imm`, a HINT that RISC-V leaves to custom use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace torolux::protocol {

/// The immediate of the HINT, -2048..2047. Arguments and results lie in the NIU window.
/// Local memory changes from outside only inside `send_*` (slots and buffers are read) and `receive*`.
enum class Hint : std::int32_t {
  /// Send `window.send` as a packet of records over the torus. Waits while the outgoing queue is full.
  /// The slots listed are read and, where they belong to the NIU, freed, before the HINT ends.
  send_records = 1,
  /// Send `window.send` as a message over the bus to the host or the FBC. Waits while the outgoing queue is full.
  send_message = 2,
  /// Sleep until the NIU wakes the processor, then bring the first packet or message in: fills `window.arrival`.
  /// It wakes at once for a message, and for records as `window.gather` says.
  receive = 3,
  /// As `receive`, but where nothing has come by now, `window.arrival.kind` is `none` and the processor goes on.
  receive_if_any = 4,
  /// Write the PE's clock to `window.clock`.
  clock = 5,
  /// Tell the NIU where the record slots are: `window.slots`. All slots must be free. Once before each stage.
  set_slots = 6,
  /// The program has ended. Does not return.
  halt = 7,
  /// The program has failed: as halt, but ends the run; `window.fault` says why.
  fail = 8,
  /// As `receive_if_any`, but only for the rest of what had gathered when the NIU last woke the processor, or would
  /// have, had it not been busy. So the answer depends on what other PEs did in the past, and not now.
  receive_more = 9,
  /// As `receive_if_any`, but only for what the NIU would have woken the processor for by now at the ticks of
  /// `window.gather`: for a processor that has work, and looks now and then. Its answer, too, depends on the past only.
  receive_due = 10,
  /// enter_phase + p and leave_phase + p, p in 0..kPhases-1: markers for the profile. They cost no cycles and may nest.
  enter_phase = 64,
  leave_phase = 128,
};

/// Phases of the profile: where a PE's cycles go. Each cycle belongs to the innermost one.
enum class Phase : std::uint8_t {
  load,      ///< bytes into the stores
  shoot,     ///< records of a shot made, and followed as far as this PE goes
  traverse,  ///< through subspaces, against polygons
  shade,     ///< mirror, glass, glossy lobes, what a ray sees
  deposit,   ///< flux into elements
  flush,     ///< batches, pixels and credits that wait are sent
  control,   ///< messages of the host
  dispatch,  ///< the PE's loop: received, what next; records checked, put into batches, ended
  program,   ///< whatever a program does in no other phase, from its first instruction on (firmware/boot)
  count
};
inline constexpr std::uint32_t kPhases = 16;
/// Names of the phases, in their order.
inline constexpr std::array<const char*, static_cast<std::size_t>(Phase::count)> kPhaseNames = {
    "load", "shoot", "traverse", "shade", "deposit", "flush", "control", "dispatch", "program"};
static_assert(static_cast<std::uint32_t>(Phase::count) <= kPhases);

/// `slti x0, x0, imm`: opcode 0x13, funct3 2, rd = rs1 = x0. Always a 4-byte instruction.
constexpr std::uint32_t hint_instruction(std::int32_t immediate) {
  return (static_cast<std::uint32_t>(immediate) << 20U) | 0x0000'2013U;
}
constexpr bool is_hint(std::uint32_t instruction) {
  return (instruction & 0x000F'FFFFU) == 0x0000'2013U;
}
constexpr std::int32_t hint_immediate(std::uint32_t instruction) {
  return static_cast<std::int32_t>(instruction) >> 20;
}
/// Whether a HINT with this immediate is a phase marker.
constexpr bool is_phase_marker(std::int32_t immediate) {
  const auto marks = [immediate](Hint first) {
    const auto from = static_cast<std::int32_t>(first);
    return immediate >= from && immediate < from + static_cast<std::int32_t>(kPhases);
  };
  return marks(Hint::enter_phase) || marks(Hint::leave_phase);
}
static_assert(hint_immediate(hint_instruction(-5)) == -5 && is_hint(hint_instruction(-5)));

}  // namespace torolux::protocol
