// SPDX-License-Identifier: MIT
// Registers, memory, breakpoints and watchpoints of the PE that the debugger has chosen.
#include <algorithm>

#include "emulator/debugger/registers.hpp"
#include "emulator/debugger/session.hpp"
#include "emulator/debugger/words.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux::debugger {
namespace {

constexpr const char* kError = "E01";
constexpr std::size_t kMostPoints = 4096;  // of a PE: each step looks at them
constexpr std::uint32_t kMostRead = kMostPacketBytes / 2 - 64;

/// What of a range is local memory, from its beginning.
std::span<std::byte> inside(HeldPe& held, const MemoryRange& range) {
  const std::span<std::byte> memory = held.pe->memory();
  if (range.address < protocol::kLocalMemoryBase) return {};
  const std::size_t offset = range.address - protocol::kLocalMemoryBase;
  if (offset >= memory.size()) return {};
  return memory.subspan(offset, std::min<std::size_t>(range.bytes, memory.size() - offset));
}

}  // namespace

/// Null: there is none that could be looked at.
HeldPe* Session::chosen() {
  HeldPe* const held = execution_.find(chosen_);
  return held != nullptr && held->pe != nullptr && !exit_code_ ? held : nullptr;
}

std::string Session::read_registers() {
  const HeldPe* const held = chosen();
  if (held == nullptr) return kError;
  const PeRegisters registers = held->pe->registers();
  std::string text;
  for (unsigned number = 0; number < kGeneralRegisters; ++number) text += *register_text(registers, number);
  return text;
}

std::string Session::read_one(std::string_view number) {
  const HeldPe* const held = chosen();
  const auto which = number_in(number);
  if (held == nullptr || !which) return kError;
  return register_text(held->pe->registers(), *which).value_or(kError);
}

std::string Session::write_registers(std::string_view text) {
  constexpr std::size_t kDigits = 8;
  HeldPe* const held = chosen();
  if (held == nullptr || text.size() != kDigits * kGeneralRegisters) return kError;
  PeRegisters registers = held->pe->registers();
  for (unsigned number = 0; number < kGeneralRegisters; ++number) {
    if (!set_register(registers, number, text.substr(kDigits * number, kDigits))) return kError;
  }
  return set_registers(*held, registers);
}

std::string Session::write_one(std::string_view text) {
  HeldPe* const held = chosen();
  const auto number = number_in(take_until(text, '='));
  if (held == nullptr || !number) return kError;
  PeRegisters registers = held->pe->registers();
  if (!set_register(registers, *number, text)) return kError;
  return set_registers(*held, registers);
}

std::string Session::set_registers(HeldPe& held, const PeRegisters& registers) {
  if (!held.stands_between()) return kError;  // what its HINT does hangs on what they were
  add_edit(held, {.steps = held.steps, .registers = registers});
  return "OK";
}

std::string Session::read_memory(std::string_view range) {
  HeldPe* const held = chosen();
  auto wanted = memory_range(range);
  if (held == nullptr || !wanted) return kError;
  wanted->bytes = std::min(wanted->bytes, kMostRead);
  const auto bytes = inside(*held, *wanted);
  return bytes.empty() && wanted->bytes != 0 ? kError : hex_of(std::span<const std::byte>(bytes));
}

std::string Session::write_memory(std::string_view text, bool in_hexadecimal) {
  HeldPe* const held = chosen();
  const auto range = memory_range(take_until(text, ':'));
  if (held == nullptr || !range) return kError;
  const auto plain = std::as_bytes(std::span(text));
  const auto bytes = in_hexadecimal ? bytes_in(text) : std::vector<std::byte>(plain.begin(), plain.end());
  if (!bytes || bytes->size() != range->bytes) return kError;
  if (bytes->empty()) return "OK";
  const bool may = held->stands_between() && inside(*held, *range).size() == bytes->size() &&
                   !held->pe->is_code(range->address, range->bytes);
  if (!may) return kError;
  add_edit(*held, {.steps = held->steps, .address = range->address, .bytes = *bytes});
  return "OK";
}

/// What comes behind will not be as it was.
void Session::add_edit(HeldPe& held, Edit edit) {
  for (HeldPe& other : execution_.pes()) {
    std::erase_if(other.edits, [&other](const Edit& old) { return old.steps > other.steps; });
  }
  const auto& pes = execution_.pes();
  const auto place = std::ranges::find_if(pes, [&held](const HeldPe& one) { return &one == &held; }) - pes.begin();
  history_.forget_behind(now(), static_cast<std::size_t>(place));
  held.edits.push_back(std::move(edit));
  make_due_edits(held);
}

std::string Session::set_point(std::string_view text, bool is_set) {
  HeldPe* const held = chosen();
  const auto point = point_in(text);
  if (held == nullptr) return kError;
  if (!point) return "";
  std::erase(held->points, *point);
  if (is_set && held->points.size() >= kMostPoints) return kError;
  if (is_set) held->points.push_back(*point);
  return "OK";
}

}  // namespace torolux::debugger
