// SPDX-License-Identifier: MIT
// Faults of PEs in words.
#include "emulator/machine/faults.hpp"

#include <array>
#include <string_view>

#include "emulator/engines/image/source_line.hpp"
#include "emulator/hexadecimal.hpp"
#include "emulator/phase_names.hpp"
#include "emulator/printable.hpp"
#include "firmware/protocol/fault_fields.hpp"
#include "firmware/protocol/machine.hpp"
#include "firmware/protocol/messages.hpp"

namespace torolux {

namespace {

/// RISC-V privileged architecture, table of mcause values.
std::string cause_in_words(std::uint32_t mcause) {
  constexpr std::array<std::string_view, 16> kCauses = {"misaligned instruction address",
                                                        "no access to the instruction",
                                                        "illegal instruction",
                                                        "breakpoint",
                                                        "misaligned load",
                                                        "load outside local memory",
                                                        "misaligned store",
                                                        "store outside local memory",
                                                        "environment call from user mode",
                                                        "environment call from supervisor mode",
                                                        "reserved cause 10",
                                                        "environment call",
                                                        "instruction page fault",
                                                        "load page fault",
                                                        "reserved cause 14",
                                                        "store page fault"};
  if (mcause < kCauses.size()) return std::string(kCauses[mcause]);
  return "cause " + hexadecimal(mcause);
}

constexpr std::uint32_t kStoreAccess = 7;  // mcause

/// What a store does that is refused: the code and the stack below it have pages of their own (linker/pe.ld).
std::string store_in_words(std::uint32_t address, const Image& image) {
  constexpr std::uint32_t kPage = protocol::kPageBytes;
  for (const ImageSymbol& symbol : image.symbols) {
    const bool below = address < symbol.address && address + kPage > symbol.address;
    if ((symbol.name == "image_stack_begin" || symbol.name == "image_code_end") && below) {
      return "store into a page of code, right below the stack: a constant, or a stack overflow?";
    }
  }
  for (const ImageSegment& segment : image.segments) {
    const std::uint32_t end = (segment.address + segment.memory_bytes + kPage - 1) / kPage * kPage;
    if (segment.executable && address >= segment.address && address < end) return "store into a page of code";
  }
  return "store outside local memory";
}

std::string_view name_of(protocol::FaultCode code) {
  using enum protocol::FaultCode;
  switch (code) {
    case trap:
      return "trap";
    case protocol_version:
      return "protocol versions of image and emulator differ";
    case bad_layout:
      return "bad layout of a stage";
    case outside_store:
      return "index outside a store";
    case unknown_message:
      return "unknown message";
    case unexpected_message:
      return "unexpected message";
    case bad_record:
      return "bad record";
    case own_slots_exhausted:
      return "own record slots exhausted";
    case release_list_full:
      return "list of released slots full";
    case short_message:
      return "message too short";
    case words:
      return "a text that does not lie in local memory";
    default:
      return "fault of the program";
  }
}

std::string_view name_of(NiuFaultCode code) {
  using enum NiuFaultCode;
  switch (code) {
    case unknown_hint:
      return "HINT unknown to the NIU (immediate)";
    case bad_count:
      return "wrong number of records in a packet, or no slots set (records, bytes of one)";
    case bad_slot:
      return "no such record slot (slot, own slots, NIU's slots)";
    case slot_not_in_use:
      return "record slot released that is not in use (slot)";
    case bad_destination:
      return "no such destination (destination)";
    case bad_address:
      return "message outside local memory (address, bytes)";
    case bad_message_length:
      return "message too long (bytes)";
    case bad_slots:
      return "record slots outside local memory, or badly sized (address, own, NIU's)";
    case slots_in_use:
      return "record slots set while some are in use (slots in use)";
    case too_many_released:
      return "more slots released than the list holds (slots)";
    case phase_mismatch:
      return "phase markers do not nest";
    case too_long_without_hint:
      return "an endless loop";
    case no_trap_handler:
      return "a trap without a handler";
    case wait_for_interrupt:
      return "wait for an interrupt";
  }
  return "fault";
}

/// By the names that the statistics have, too.
std::string phases_in_words(const std::uint32_t (&detail)[3], const PhaseNames& names) {
  const auto name = [&names](std::uint32_t phase) {
    return phase < names.size() ? "the phase " + phase_name(names, phase)
                                : "a phase that is none, " + std::to_string(phase);
  };
  if (detail[2] != 0)
    return name(detail[0]) + " is entered where " + std::to_string(names.size()) + " are open, the most";
  return name(detail[0]) + " is left, but " +
         (detail[1] < names.size() ? "the innermost that is open is " + phase_name(names, detail[1]) : "none is open");
}

/// The program of the PE in question.
struct Code {
  const Image& image;
  const DebugInfo& debug_info;
};

std::string place_in_words(std::uint32_t pc, const Code& code) {
  const std::string line = source_line(code.debug_info, pc);
  return "pc " + hexadecimal(pc) + " (" + code.image.describe(pc) + (line.empty() ? "" : ", " + line) + ")";
}

/// mcause, mepc, mtval.
std::string trap_in_words(const std::uint32_t (&detail)[3], const Code& code) {
  const std::string what =
      detail[0] == kStoreAccess ? store_in_words(detail[2], code.image) : cause_in_words(detail[0]);
  return "trap: " + what + " at " + place_in_words(detail[1], code) + ", mtval " + hexadecimal(detail[2]);
}

std::string loop_in_words(const std::uint32_t (&detail)[3], const Code& code) {
  const std::string most = std::to_string((std::uint64_t{detail[1]} << 32U) | detail[0]);
  const std::string place = detail[2] != 0 ? ", now at " + place_in_words(detail[2], code) : "";
  return "no HINT for more than " + most + " cycles" + place +
         ": an endless loop? (processor.most_cycles_between_hints = " + most + ")";
}

std::string details(const std::uint32_t (&detail)[3]) {
  return std::to_string(detail[0]) + ", " + std::to_string(detail[1]) + ", " + std::to_string(detail[2]);
}

/// The words, with the second and the third detail where a % stands; nothing of no words.
std::string filled(std::string_view words, const std::uint32_t (&detail)[3]) {
  std::string text = words.empty() ? "" : ": ";
  std::size_t next = 1;
  for (const char c : words) text += c == '%' ? std::to_string(detail[next++]) : std::string(1, c);
  return text;
}

/// What pe.elf has found wrong, with value and limit; nothing where the numbers alone tell.
std::string in_words(protocol::FaultCode code, const std::uint32_t (&detail)[3]) {
  using enum protocol::FaultCode;
  switch (code) {
    case protocol_version:
      return ": the image's is " + std::to_string(detail[0]) + ", the emulator's " + std::to_string(detail[1]);
    case bad_layout:
      return filled(protocol::words_in(protocol::kLayoutFieldWords, detail[0]), detail);
    case outside_store:
      return filled(protocol::words_in(protocol::kStoreIndexWords, detail[0]), detail);
    case bad_record:
      return filled(protocol::words_in(protocol::kRecordFieldWords, detail[0]), detail);
    case unknown_message:
    case unexpected_message:
      return ": kind " + std::to_string(detail[0]);
    case own_slots_exhausted:
      return ": all " + std::to_string(detail[0]) + " are in use";
    case short_message:
      return ": kind " + std::to_string(detail[0]) + ", " + std::to_string(detail[1]) + " bytes instead of " +
             std::to_string(detail[2]);
    default:
      return "";
  }
}

/// What the program says itself, with the place; nothing where it has left no text.
std::string own_words(const std::uint32_t (&detail)[3], const Code& code, std::span<const std::byte> local_memory) {
  const std::uint64_t offset = std::uint64_t{detail[0]} - protocol::kLocalMemoryBase;
  if (detail[0] < protocol::kLocalMemoryBase || detail[1] == 0 || detail[1] > protocol::kMostFaultWords ||
      offset + detail[1] > local_memory.size()) {
    return "";
  }
  std::string text;
  for (const std::byte byte : local_memory.subspan(offset, detail[1])) text += static_cast<char>(byte);
  return printable(std::move(text)) + (detail[2] != 0 ? "; called at " + place_in_words(detail[2], code) : "");
}

}  // namespace

std::string describe_fault(unsigned pe, const protocol::Fault& fault, CallStacks& stacks) {
  const Code code{stacks.image_of(pe), stacks.debug_info_of(pe)};
  const std::string who = "PE " + std::to_string(pe) + ": ";
  const auto kind = static_cast<protocol::FaultCode>(fault.code);
  if (kind == protocol::FaultCode::trap) return who + trap_in_words(fault.detail, code);
  if (kind == protocol::FaultCode::words) {
    if (const std::string text = own_words(fault.detail, code, stacks.memory_of(pe)); !text.empty()) return who + text;
  }
  return who + "the program failed: code " + std::to_string(fault.code) + " (in pe.elf: " + std::string(name_of(kind)) +
         in_words(kind, fault.detail) + "), details " + details(fault.detail) + "; see docs/errors.md";
}

std::string describe_fault(unsigned pe, const NiuFault& fault, CallStacks& stacks) {
  const Code code{stacks.image_of(pe), stacks.debug_info_of(pe)};
  const std::string who = "PE " + std::to_string(pe) + ": ";
  if (fault.code == NiuFaultCode::too_long_without_hint) return who + loop_in_words(fault.detail, code);
  if (fault.code == NiuFaultCode::no_trap_handler) {
    const bool known = fault.detail[0] != kUnknownTrap;
    return who + (known ? trap_in_words(fault.detail, code) : "a trap of which this engine knows no more") +
           "; it executes no instructions any more: mtvec leads to no handler";
  }
  if (fault.code == NiuFaultCode::wait_for_interrupt) {
    return who + "trap: wfi at " + place_in_words(fault.detail[0], code) +
           " waits for an interrupt, and there are none: call receive() to wait";
  }
  const std::string what = who + std::string(name_of(fault.code)) + ": ";
  if (fault.code == NiuFaultCode::phase_mismatch) return what + phases_in_words(fault.detail, code.image.phase_names);
  return what + details(fault.detail);
}

std::string calls_to(unsigned pe, const NiuFault& fault, CallStacks& stacks) {
  const std::uint32_t place = fault.detail[2];
  switch (fault.code) {
    case NiuFaultCode::too_long_without_hint:
      return place != 0 ? stacks.of_pe(pe, place) : stacks.of_pe(pe);
    case NiuFaultCode::no_trap_handler:
    case NiuFaultCode::wait_for_interrupt:
    case NiuFaultCode::phase_mismatch:  // the program has gone on to its next HINT
      return "";                        // not every engine knows the registers there
    default:
      return stacks.of_pe(pe);
  }
}

}  // namespace torolux
