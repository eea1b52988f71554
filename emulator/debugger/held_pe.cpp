// SPDX-License-Identifier: MIT
// Breakpoints compare the pc; watchpoints the instruction's own address, and what a HINT has changed.
#include "emulator/debugger/held_pe.hpp"

#include <algorithm>
#include <cstring>

#include "firmware/protocol/hints.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux::debugger {
namespace {

bool watches(const Point& point, const MemoryAccess& access) {
  const bool kind =
      (access.writes && point.kind != PointKind::read) || (access.reads && point.kind != PointKind::write);
  const std::uint64_t end = std::uint64_t{point.address} + std::max(point.bytes, 1U);
  return point.kind != PointKind::breakpoint && kind && access.address < end &&
         point.address < std::uint64_t{access.address} + access.bytes;
}

/// What of local memory a watchpoint covers.
std::span<const std::byte> covered(HeldPe& held, const Point& point) {
  const std::span<const std::byte> memory = held.pe->memory();
  const std::uint64_t offset = std::uint64_t{point.address} - protocol::kLocalMemoryBase;
  if (point.address < protocol::kLocalMemoryBase || offset >= memory.size()) return {};
  return memory.subspan(offset, std::min<std::size_t>(point.bytes, memory.size() - offset));
}

Stop watched(const HeldPe& held, const Point& point) {
  return {.reason = Stop::Reason::watch, .pe = held.number, .watch = point.kind, .address = point.address};
}

/// The NIU writes local memory only inside a HINT.
class WatchedByNiu {
 public:
  explicit WatchedByNiu(HeldPe& held) {
    for (const Point& point : held.points) {
      if (point.kind != PointKind::write && point.kind != PointKind::access) continue;
      const auto bytes = covered(held, point);
      before_.push_back({point, {bytes.begin(), bytes.end()}});
    }
  }
  std::optional<Stop> changed(HeldPe& held) const {
    for (const auto& [point, bytes] : before_) {
      if (!std::ranges::equal(covered(held, point), bytes)) return watched(held, point);
    }
    return std::nullopt;
  }

 private:
  struct Before {
    Point point;
    std::vector<std::byte> bytes;
  };
  std::vector<Before> before_;
};

std::optional<Stop> watched_access(const HeldPe& held) {
  const auto access = held.pe->next_access();
  if (!access) return std::nullopt;
  const auto found = std::ranges::find_if(held.points, [&](const Point& point) { return watches(point, *access); });
  return found != held.points.end() ? std::optional(watched(held, *found)) : std::nullopt;
}

}  // namespace

void make_due_edits(HeldPe& held) {
  while (held.edits_made < held.edits.size() && held.edits[held.edits_made].steps == held.steps) {
    const Edit& edit = held.edits[held.edits_made++];
    if (edit.registers) held.pe->set_registers(*edit.registers);
    if (edit.bytes.empty()) continue;
    const auto place = held.pe->memory().subspan(edit.address - protocol::kLocalMemoryBase, edit.bytes.size());
    std::ranges::copy(edit.bytes, place.begin());
  }
}

void set_steps(HeldPe& held, std::uint64_t steps, bool edits_made_here) {
  held.steps = steps;
  held.edits_made = 0;
  for (const Edit& edit : held.edits) {
    if (edit.steps < steps || (edits_made_here && edit.steps == steps)) ++held.edits_made;
  }
}

std::optional<Stop> stop_before(const HeldPe& held) {
  if (!held.stands_between()) return std::nullopt;
  const std::uint32_t pc = held.pe->pc();
  const auto is_here = [pc](const Point& point) { return point.kind == PointKind::breakpoint && point.address == pc; };
  if (std::ranges::any_of(held.points, is_here)) {
    return Stop{.reason = Stop::Reason::breakpoint, .pe = held.number};
  }
  if (held.pe->next_hint() == static_cast<std::int32_t>(protocol::Hint::fail)) {
    return Stop{.reason = Stop::Reason::failure, .pe = held.number};
  }
  return std::nullopt;
}

Stepped step(HeldPe& held, bool stops_at_trap) {
  using enum DebuggedPe::Step;
  std::optional<Stop> stop;
  std::optional<WatchedByNiu> by_niu;
  if (!held.points.empty()) {
    stop = held.stands_between() ? watched_access(held) : std::nullopt;
    if (held.pe->next_hint()) by_niu.emplace(held);
  }
  const DebuggedPe::Step how = held.pe->step(stops_at_trap);
  if (how == waits) return {how};
  if (how == traps) {
    return {how, Stop{.reason = Stop::Reason::trap, .pe = held.number, .cause = held.pe->trap_cause()}};
  }
  ++held.steps;
  if (by_niu) stop = by_niu->changed(held);
  return {how, stop};
}

}  // namespace torolux::debugger
