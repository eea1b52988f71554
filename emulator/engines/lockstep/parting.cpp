// SPDX-License-Identifier: MIT
// Both run side by side, at first in great strides; where they part, once more from the start, and there in small ones.
#include "emulator/engines/lockstep/parting.hpp"

#include <algorithm>
#include <vector>

#include "emulator/engines/translated/run/interpreter.hpp"
#include "firmware/protocol/hints.hpp"

namespace torolux::lockstep {
namespace {

using translated::Interpreter;
using translated::TranslatedImage;
using translated::TranslatedPe;

/// Strides of the first search.
constexpr std::uint64_t kStrides = 1000;

class SideBySide {
 public:
  SideBySide(const TranslatedImage& code, const translated::CodeMap& map, const TranslatedPe& start,
             std::span<const std::byte> memory)
      : code_(code),
        interpreter_(map),
        memory_(memory.begin(), memory.end()),
        other_memory_(memory_),
        pe_(start),
        other_(start) {
    pe_.memory = memory_.data();
    other_.memory = other_memory_.data();
    pe_.marker = [](void*, std::int32_t, std::uint64_t, std::uint64_t) {};
  }

  /// Translated code runs to the next jump that is not before this clock, the interpreter as far. False: they differ.
  bool advance(std::uint64_t clock) {
    pe_.cycle_limit = clock;
    ended_ = code_.run(pe_) != TranslatedImage::Stop::cycle_limit;
    bool runs = true;
    while (runs && other_.cycles < pe_.cycles) {
      const Interpreter::Step step = interpreter_.step(other_);
      const bool hint = step == Interpreter::Step::hint && !protocol::is_phase_marker(other_.hint_immediate);
      runs = step == Interpreter::Step::done || (step == Interpreter::Step::hint && !hint);
    }
    return pe_.pc == other_.pc && pe_.cycles == other_.cycles && memory_ == other_memory_;
  }
  /// Translated code is at a HINT, or stuck.
  bool ended() const { return ended_; }

  std::uint64_t clock() const { return pe_.cycles; }
  Parting::Place translated() const { return {pe_.pc, pe_.cycles}; }
  Parting::Place interpreted() const { return {other_.pc, other_.cycles}; }
  std::optional<std::uint32_t> different_byte() const {
    const auto [left, right] = std::mismatch(memory_.begin(), memory_.end(), other_memory_.begin());
    if (left == memory_.end()) return std::nullopt;
    return static_cast<std::uint32_t>(left - memory_.begin());
  }

 private:
  const TranslatedImage& code_;
  Interpreter interpreter_;
  std::vector<std::byte> memory_, other_memory_;
  TranslatedPe pe_, other_;
  bool ended_ = false;
};

}  // namespace

std::optional<Parting> find_parting(const TranslatedImage& code, const translated::CodeMap& map,
                                    const TranslatedPe& start, std::span<const std::byte> memory, std::uint64_t until) {
  const std::uint64_t stride = 1 + (std::max(until, start.cycles) - start.cycles) / kStrides;
  std::uint64_t same_until = start.cycles;
  SideBySide coarse(code, map, start, memory);
  while (coarse.advance(same_until + stride)) {
    if (coarse.ended() || coarse.clock() > until) return std::nullopt;
    same_until = coarse.clock();
  }
  SideBySide fine(code, map, start, memory);
  if (same_until > start.cycles) fine.advance(same_until);
  Parting parting{fine.translated(), {}, {}, {}};
  while (fine.advance(fine.clock() + 1) && !fine.ended()) parting.same = fine.translated();
  parting.translated = fine.translated();
  parting.interpreted = fine.interpreted();
  parting.byte = fine.different_byte();
  return parting;
}

}  // namespace torolux::lockstep
