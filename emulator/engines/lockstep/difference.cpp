// SPDX-License-Identifier: MIT
// Compares, and tells.
#include "emulator/engines/lockstep/difference.hpp"

#include <algorithm>
#include <cstring>
#include <iomanip>
#include <sstream>

#include "emulator/engines/lockstep/disassembly.hpp"
#include "emulator/engines/lockstep/parting.hpp"
#include "emulator/engines/lockstep/trace.hpp"
#include "emulator/hexadecimal.hpp"

namespace torolux::lockstep {
namespace {

using translated::TranslatedPe;

/// The interpreter is given so many instructions more than QEMU took.
constexpr std::uint64_t kMostMore = 100'000;
constexpr std::uint64_t kNoLimit = ~std::uint64_t{0};

/// A trap has led the program to where it is.
bool has_trapped(const TranslatedPe& pe) {
  return pe.mcause != 0;
}

std::string name_of_hint(std::int32_t immediate) {
  constexpr std::array<const char*, 11> kNames = {
      "",          "send_records", "send_message", "receive",      "receive_if_any", "clock",
      "set_slots", "halt",         "fail",         "receive_more", "receive_due"};
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
  if (stop == TranslatedImage::Stop::stuck || stop == TranslatedImage::Stop::waits) {
    return "the translated engine alone cannot go on";
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

std::string place_text(const PeInQuestion& pe, std::uint32_t pc, std::uint64_t clock) {
  return "pc " + pe.image.describe(pc) + ", clock " + std::to_string(clock);
}

void print_parting(std::ostream& out, const PeInQuestion& pe, const Parting& parting) {
  const auto place = [&](const Parting::Place& at) { return place_text(pe, at.pc, at.clock); };
  out << "\n  Translated and interpreted, it goes the same way up to " << place(parting.same)
      << ".\n    From there translated:  to " << place(parting.translated) << "\n    From there interpreted: to "
      << place(parting.interpreted);
  if (parting.byte) out << "\n    Memory differs then at " << hexadecimal(translated::kMemoryBase + *parting.byte);
}

void print_instructions(std::ostream& out, const PeInQuestion& pe, const Trace& trace) {
  out << "\n  The last instructions that the interpreter executes up to there, of " << trace.instructions << " since "
      << (pe.hint == 1 ? "the start" : "HINT " + std::to_string(pe.hint - 1)) << " (clock " << pe.last_hint_clock
      << "):";
  for (const TracedInstruction& traced : trace.last) {
    out << "\n    clock " << std::left << std::setw(12) << traced.clock << hexadecimal(traced.instruction.bits) << "  "
        << std::setw(32) << disassemble(traced.instruction, traced.pc) << pe.image.describe(traced.pc);
  }
}

/// The way from the last HINT to this one as the interpreter goes it, any number of times.
class Way {
 public:
  Way(const PeInQuestion& pe, Shadow& shadow, std::uint64_t most_instructions)
      : pe_(pe),
        shadow_(shadow),
        start_(shadow.pe()),
        memory_(shadow.memory().begin(), shadow.memory().end()),
        most_instructions_(most_instructions) {}

  /// clock: to stop at.
  Trace trace(std::optional<std::uint32_t> watched, std::uint64_t clock) {
    shadow_.pe() = start_;
    std::ranges::copy(memory_, shadow_.memory().begin());
    return trace_to_hint(pe_.map, shadow_.pe(), watched, {most_instructions_, clock});
  }
  std::optional<Parting> parting(std::uint64_t until) const {
    return find_parting(pe_.code, pe_.map, start_, memory_, until);
  }

 private:
  const PeInQuestion& pe_;
  Shadow& shadow_;
  TranslatedPe start_;
  std::vector<std::byte> memory_;
  std::uint64_t most_instructions_;
};

/// The instructions up to where the ways part, or up to where the byte that differs there has been stored.
Trace trace_to_parting(Way& way, const Parting& parting) {
  const std::uint64_t end = parting.interpreted.clock;
  if (!parting.byte) return way.trace(std::nullopt, end);
  const Trace trace = way.trace((translated::kMemoryBase + *parting.byte) & ~3U, end);
  const bool stored = trace.store && trace.store->clock > parting.same.clock;
  return stored ? way.trace(std::nullopt, trace.store->clock) : trace;
}

}  // namespace

std::optional<Difference> find_difference(const HintMeeting& qemu, Shadow& shadow, TranslatedImage::Stop stop) {
  const auto offset = shadow.memories().first_difference();
  std::string what = what_differs(qemu, shadow, stop, offset.has_value());
  if (what.empty()) return std::nullopt;
  Difference difference{std::move(what), stop == TranslatedImage::Stop::hint, std::nullopt};
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
  const Party of_translated = party(shadow.pe(), difference.at_hint);
  shadow.go_back();
  Way way(pe, shadow, qemu.instructions - shadow.pe().instructions + kMostMore);
  const auto parting = way.parting(qemu.clock + kMostMore);
  const std::optional<Trace> up_to_parting = parting ? std::optional(trace_to_parting(way, *parting)) : std::nullopt;
  const Trace trace = way.trace(word, kNoLimit);
  const Party of_interpreter = party(shadow.pe(), trace.at_hint);

  std::ostringstream out;
  out << "PE " << pe.number << ": QEMU and the translated engine part at its HINT " << pe.hint << ": "
      << difference.what;
  print_table(out, word ? hexadecimal(*word) + " (" + pe.image.describe(*word) + ")" : "",
              {of_qemu, of_translated, of_interpreter});
  if (trace.store) {
    out << "\n  Last stored there, as interpreted, at " << place_text(pe, trace.store->pc, trace.store->clock) << ": "
        << hexadecimal(trace.store->word);
  } else if (word) {
    out << "\n  As interpreted, nothing has been stored there since the last HINT.";
  }
  if (parting) print_parting(out, pe, *parting);
  print_instructions(out, pe, up_to_parting ? *up_to_parting : trace);
  return out.str();
}

}  // namespace torolux::lockstep
