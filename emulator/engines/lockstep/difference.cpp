// SPDX-License-Identifier: MIT
// Compares, and tells.
#include "emulator/engines/lockstep/difference.hpp"

#include <algorithm>
#include <cstring>
#include <iomanip>
#include <sstream>

#include "emulator/engines/lockstep/disassembly.hpp"
#include "emulator/engines/lockstep/trace.hpp"

namespace torolux::lockstep {
namespace {

using translated::TranslatedPe;

/// The interpreter is given so many instructions more than QEMU took.
constexpr std::uint64_t kMostMore = 100'000;

/// A trap has led the program to where it is.
bool has_trapped(const TranslatedPe& pe) {
  return pe.mcause != 0;
}

std::string name_of_hint(std::int32_t immediate) {
  constexpr std::array<const char*, 10> kNames = {"",      "send_records", "send_message", "receive", "receive_if_any",
                                                  "clock", "set_slots",    "halt",         "fail",    "receive_more"};
  const bool known = immediate > 0 && immediate < static_cast<std::int32_t>(kNames.size());
  return known ? kNames[static_cast<std::size_t>(immediate)] : "unknown (" + std::to_string(immediate) + ")";
}

/// The first phase marker that differs, among those that are still known.
std::string describe_markers(const MarkerTrail& qemu, const MarkerTrail& translated) {
  const std::uint64_t most = std::max(qemu.count, translated.count);
  const std::uint64_t begin = most < MarkerTrail::kKept ? 0 : most - MarkerTrail::kKept;
  for (std::uint64_t n = begin; n < std::min(qemu.count, translated.count); ++n) {
    const PassedMarker& a = qemu.last[n % MarkerTrail::kKept];
    const PassedMarker& b = translated.last[n % MarkerTrail::kKept];
    if (a == b) continue;
    const auto text = [](const PassedMarker& marker) {
      return std::to_string(marker.immediate) + " at clock " + std::to_string(marker.clock) + " after " +
             std::to_string(marker.instructions) + " instructions";
    };
    return "phase marker " + std::to_string(n + 1) + " (QEMU: " + text(a) + "; translated: " + text(b) + ")";
  }
  return "the phase markers passed (QEMU: " + std::to_string(qemu.count) +
         ", translated: " + std::to_string(translated.count) + ")";
}

std::string what_differs(const HintMeeting& qemu, Shadow& shadow, TranslatedImage::Stop stop, bool memory_differs) {
  const TranslatedPe& pe = shadow.pe();
  if (stop == TranslatedImage::Stop::stuck) {
    return pe.stray ? "the translated engine alone cannot go on (a jump that it did not foresee)"
                    : "the translated engine alone cannot go on";
  }
  if (stop == TranslatedImage::Stop::cycle_limit) return "the translated engine alone has met no HINT";
  if (pe.hint_immediate != qemu.immediate) return "the HINTs differ";
  const bool counts = !has_trapped(pe);
  const MarkerTrail& markers = shadow.markers();
  const bool same_markers = markers.count == qemu.markers.count && (!counts || markers.hash == qemu.markers.hash);
  if (!same_markers) return describe_markers(qemu.markers, markers) + " differs";
  if (counts && pe.cycles != qemu.clock) return "the clocks differ";
  if (counts && pe.instructions != qemu.instructions) return "the numbers of instructions differ";
  return memory_differs ? "local memory differs" : "";
}

std::string hexadecimal(std::uint32_t value) {
  std::ostringstream text;
  text << "0x" << std::hex << std::setw(8) << std::setfill('0') << value;
  return text.str();
}

std::uint32_t word_at(std::span<const std::byte> memory, std::uint32_t address) {
  std::uint32_t value = 0;
  std::memcpy(&value, &memory[address - translated::kMemoryBase], sizeof value);
  return value;
}

/// One of three to compare.
struct Party {
  std::string hint, clock, instructions, word;
};

void print_table(std::ostream& out, const std::string& place, const std::array<Party, 3>& parties) {
  constexpr int kLabel = 14;
  constexpr int kColumn = 22;
  const auto row = [&](const std::string& label, const std::string Party::*value) {
    out << "\n  " << std::left << std::setw(kLabel) << label;
    for (const Party& party : parties) out << std::setw(kColumn) << party.*value;
  };
  out << "\n  " << std::left << std::setw(kLabel) << "" << std::setw(kColumn) << "QEMU" << std::setw(kColumn)
      << "translated"
      << "interpreted";
  row("HINT", &Party::hint);
  row("clock", &Party::clock);
  row("instructions", &Party::instructions);
  if (place.empty()) return;
  row("word", &Party::word);
  out << "\n  That word, at " << place << ", is the first that differs in local memory.";
}

void print_trace(std::ostream& out, const PeInQuestion& pe, const Trace& trace, bool word_differs) {
  if (trace.store) {
    out << "\n  Last stored there at pc " << pe.image.describe(trace.store->pc) << ", clock " << trace.store->clock
        << ": " << hexadecimal(trace.store->word) << ".";
  } else if (word_differs) {
    out << "\n  As interpreted, nothing has been stored there since the last HINT.";
  }
  out << "\n  Since " << (pe.hint == 1 ? "the start" : "HINT " + std::to_string(pe.hint - 1)) << " (clock "
      << pe.last_hint_clock << ") the interpreter has executed " << trace.instructions << " instructions; the last "
      << trace.last.size() << ":";
  for (const TracedInstruction& traced : trace.last) {
    out << "\n    clock " << std::left << std::setw(12) << traced.clock << hexadecimal(traced.instruction.bits) << "  "
        << std::setw(32) << disassemble(traced.instruction, traced.pc) << pe.image.describe(traced.pc);
  }
}

}  // namespace

std::optional<Difference> find_difference(const HintMeeting& qemu, Shadow& shadow, TranslatedImage::Stop stop) {
  const auto offset = shadow.memories().first_difference();
  std::string what = what_differs(qemu, shadow, stop, offset.has_value());
  if (what.empty()) return std::nullopt;
  Difference difference{std::move(what), std::nullopt};
  if (offset) difference.word = (translated::kMemoryBase + *offset) & ~3U;
  return difference;
}

std::string report(const PeInQuestion& pe, const Difference& difference, const HintMeeting& qemu, Shadow& shadow,
                   std::span<const std::byte> qemu_memory) {
  const auto& word = difference.word;
  const auto word_in = [&](std::span<const std::byte> memory) {
    return word ? hexadecimal(word_at(memory, *word)) : std::string();
  };
  const auto party = [&](const TranslatedPe& state, bool at_hint) {
    return Party{at_hint ? name_of_hint(state.hint_immediate) : "none: pc " + hexadecimal(state.pc),
                 std::to_string(state.cycles), std::to_string(state.instructions), word_in(shadow.memory())};
  };
  const Party of_qemu{name_of_hint(qemu.immediate), std::to_string(qemu.clock), std::to_string(qemu.instructions),
                      word_in(qemu_memory)};
  const bool had_hint = difference.what.find("alone") == std::string::npos;
  const Party of_translated = party(shadow.pe(), had_hint);
  shadow.go_back();
  const Trace trace =
      trace_to_hint(pe.code, shadow.pe(), word, qemu.instructions - shadow.pe().instructions + kMostMore);
  const Party of_interpreter = party(shadow.pe(), trace.at_hint);

  std::ostringstream out;
  out << "PE " << pe.number << ": QEMU and the translated engine part at its HINT " << pe.hint << ": "
      << difference.what;
  print_table(out, word ? hexadecimal(*word) + " (" + pe.image.describe(*word) + ")" : "",
              {of_qemu, of_translated, of_interpreter});
  print_trace(out, pe, trace, word.has_value());
  return out.str();
}

}  // namespace torolux::lockstep
