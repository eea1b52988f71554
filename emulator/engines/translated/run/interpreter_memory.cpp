// SPDX-License-Identifier: MIT
// The interpreter's loads, stores and atomics.
#include <algorithm>
#include <cstring>

#include "emulator/engines/translated/run/interpreter.hpp"

namespace torolux::translated {
namespace {

constexpr std::uint32_t kPage = 4096;

std::uint32_t sign_extended(std::uint32_t value, unsigned bits) {
  const std::uint32_t sign = 1U << (bits - 1U);
  return (value ^ sign) - sign;
}

std::uint32_t combined(Op op, std::uint32_t old, std::uint32_t operand) {
  const auto is_less = static_cast<std::int32_t>(old) < static_cast<std::int32_t>(operand);
  switch (op) {
    case Op::amoadd:
      return old + operand;
    case Op::amoxor:
      return old ^ operand;
    case Op::amoand:
      return old & operand;
    case Op::amoor:
      return old | operand;
    case Op::amomin:
      return is_less ? old : operand;
    case Op::amomax:
      return is_less ? operand : old;
    case Op::amominu:
      return std::min(old, operand);
    case Op::amomaxu:
      return std::max(old, operand);
    default:
      return operand;  // amoswap
  }
}

}  // namespace

/// As QEMU does, an access across pages is checked page by page; the address told is the access's own, or the second
/// page's.
Interpreter::MaybeFault Interpreter::check(const TranslatedPe& pe, std::uint32_t address, std::uint32_t bytes,
                                           Access access) const {
  const Cause cause = access == Access::load ? Cause::load_access : Cause::store_access;
  while (bytes != 0) {
    const std::uint32_t here = std::min(bytes, kPage - address % kPage);
    const std::uint64_t end = std::uint64_t{address - kMemoryBase} + here;
    const bool refused = end > pe.memory_bytes || !pmp_allows(pe, address, here, access) ||
                         (access == Access::store && code_.holds_code(address, here));
    if (refused) return Fault{cause, address};
    address += here;
    bytes -= here;
  }
  return std::nullopt;
}

Interpreter::MaybeFault Interpreter::load(const TranslatedPe& pe, std::uint32_t address, std::uint32_t bytes,
                                          std::uint32_t& value) const {
  if (const auto fault = check(pe, address, bytes, Access::load)) return fault;
  value = 0;
  std::memcpy(&value, pe.memory + (address - kMemoryBase), bytes);
  return std::nullopt;
}

Interpreter::MaybeFault Interpreter::store(const TranslatedPe& pe, std::uint32_t address, std::uint32_t bytes,
                                           std::uint32_t value) const {
  if (const auto fault = check(pe, address, bytes, Access::store)) return fault;
  std::memcpy(pe.memory + (address - kMemoryBase), &value, bytes);
  return std::nullopt;
}

Interpreter::MaybeFault Interpreter::memory(TranslatedPe& pe, const Instruction& i) const {
  const std::uint32_t address = pe.x[i.rs1] + i.immediate;
  const std::uint32_t bytes = accessed_bytes(i.op);
  if (i.op == Op::fsw) return store(pe, address, bytes, pe.f[i.rs2]);
  if (i.op >= Op::sb && i.op <= Op::sw) return store(pe, address, bytes, pe.x[i.rs2]);
  std::uint32_t value = 0;
  if (const auto fault = load(pe, address, bytes, value)) return fault;
  if (i.op == Op::flw) {
    pe.f[i.rd] = value;
    mark_float_dirty(pe);
    return std::nullopt;
  }
  if (i.op == Op::lb || i.op == Op::lh) value = sign_extended(value, 8 * bytes);
  pe.x[i.rd] = value;
  return std::nullopt;
}

/// A single hart: a read, then a write, each with its own right to fault. sc.w writes back what it found where that is
/// no longer what lr.w has seen.
Interpreter::MaybeFault Interpreter::atomic(TranslatedPe& pe, const Instruction& i) const {
  const std::uint32_t address = pe.x[i.rs1];
  if (i.op == Op::sc && address != pe.reserved_address) {
    pe.x[i.rd] = 1;
    pe.reserved_address = kNoReservation;
    return std::nullopt;
  }
  if (address % 4 != 0) return Fault{Cause::load_misaligned, address};
  std::uint32_t old = 0;
  if (const auto fault = load(pe, address, 4, old)) return fault;
  if (i.op == Op::lr) {
    pe.reserved_address = address;
    pe.reserved_value = old;
    pe.x[i.rd] = old;
    return std::nullopt;
  }
  if (i.op == Op::sc) {
    const bool same = old == pe.reserved_value;
    if (const auto fault = store(pe, address, 4, same ? pe.x[i.rs2] : old)) return fault;
    pe.x[i.rd] = same ? 0 : 1;
    pe.reserved_address = kNoReservation;
    return std::nullopt;
  }
  if (const auto fault = store(pe, address, 4, combined(i.op, old, pe.x[i.rs2]))) return fault;
  pe.x[i.rd] = old;
  return std::nullopt;
}

}  // namespace torolux::translated
