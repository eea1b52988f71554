// SPDX-License-Identifier: MIT
// Backward: what may still be accessed by a register's present value. Forward: what has been checked on every way.
#include "emulator/engines/translated/access_flow.hpp"

#include <algorithm>

#include "emulator/engines/translated/instruction.hpp"

namespace torolux::translated {
namespace {

/// Offsets beyond are forgotten: copies of copies may run away.
constexpr std::int32_t kFarthest = 1 << 16;

std::int32_t offset_of(const Instruction& i) {
  return static_cast<std::int32_t>(i.immediate);
}

OffsetRange hull(const OffsetRange& a, const OffsetRange& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.lowest, b.lowest), std::max(a.highest, b.highest)};
}
OffsetRange common(const OffsetRange& a, const OffsetRange& b) {
  const OffsetRange both{std::max(a.lowest, b.lowest), std::min(a.highest, b.highest)};
  return a.empty() || b.empty() || both.empty() ? OffsetRange{} : both;
}
/// The same bytes, as offsets from a register that holds `added` more.
OffsetRange seen_from(const OffsetRange& range, std::int32_t added) {
  const OffsetRange shifted{range.lowest - added, range.highest - added};
  const bool near = shifted.lowest >= -kFarthest && shifted.highest <= kFarthest;
  return range.empty() || !near ? OffsetRange{} : shifted;
}

/// Whether rd becomes rs1 or rs2 plus a number.
struct Copy {
  bool is_copy;
  unsigned from;
  std::int32_t added;
};
Copy copy_of(const Instruction& i) {
  if (i.op == Op::addi) return {true, i.rs1, offset_of(i)};
  if (i.op == Op::add && i.rs1 == 0) return {true, i.rs2, 0};
  if (i.op == Op::add && i.rs2 == 0) return {true, i.rs1, 0};
  return {false, 0, 0};
}

}  // namespace

AccessFlow::AccessFlow(const CodeMap& code, const Blocks& blocks, const Successors& successors,
                       const std::vector<std::uint32_t>& entered)
    : code_(code), blocks_(blocks) {
  for (const auto& [address, next] : successors) at_[address] = {};
  for (bool changed = true; changed;) {
    changed = false;
    for (auto found = successors.rbegin(); found != successors.rend(); ++found) {
      changed |= update_coming(blocks_.all().at(found->first), successors);
    }
  }
  for (const auto& [address, next] : successors) behind_[address] = coming_behind(next);
  for (const std::uint32_t address : entered) at_[address].reached = true;
  constexpr unsigned kPatience = 8;  // what still shrinks after so many rounds, a few bytes each time, is given up
  unsigned rounds = 0;
  for (bool changed = true; changed; ++rounds) {
    changed = false;
    for (const auto& [address, next] : successors) {
      changed |= update_known(blocks_.all().at(address), successors, rounds >= kPatience);
    }
  }
}

AccessFlow::ByBase AccessFlow::coming_behind(const std::vector<std::uint32_t>& successors) const {
  ByBase coming{};
  for (const std::uint32_t next : successors) {
    const ByBase& there = at_.at(next).coming;
    for (unsigned n = 1; n < coming.size(); ++n) {
      coming[n] = {hull(coming[n].loads, there[n].loads), hull(coming[n].stores, there[n].stores)};
    }
  }
  return coming;
}

bool AccessFlow::update_coming(const Block& block, const Successors& successors) {
  ByBase coming = coming_behind(successors.at(block.begin));
  const std::vector<std::uint32_t> addresses = addresses_in(code_, block);
  for (auto pc = addresses.rbegin(); pc != addresses.rend(); ++pc) {
    const Instruction& i = code_.at(*pc)->instruction;
    if (writes_x(i.op)) coming[i.rd] = {};
    if (!is_access(i.op)) continue;
    OffsetRange& range = is_store(i.op) ? coming[i.rs1].stores : coming[i.rs1].loads;
    range = hull(range, {offset_of(i), offset_of(i)});
  }
  const bool changed = at_[block.begin].coming != coming;
  at_[block.begin].coming = coming;
  return changed;
}

bool AccessFlow::update_known(const Block& block, const Successors& successors, bool settle) {
  if (!at_.at(block.begin).reached) return false;
  AccessChecks unused;
  const ByBase known = follow(block, unused);
  bool changed = false;
  for (const std::uint32_t next : successors.at(block.begin)) {
    AtBlock& there = at_[next];
    if (!there.reached) {
      there.reached = changed = true;
      there.known = known;
      continue;
    }
    for (unsigned n = 1; n < known.size(); ++n) {
      Ranges both{common(there.known[n].loads, known[n].loads), common(there.known[n].stores, known[n].stores)};
      if (both == there.known[n]) continue;
      there.known[n] = settle ? Ranges{} : both;
      changed = true;
    }
  }
  return changed;
}

AccessCheck AccessFlow::check_for(const Instruction& i, const Ranges& coming, const Ranges& coming_in_block) const {
  const OffsetRange here{offset_of(i), offset_of(i)};
  // A check for stores covers loads, too. But a way that only loads may have to do with constants.
  if (is_store(i.op) || !coming_in_block.stores.empty()) {
    return {true, hull(here, hull(coming.loads, coming.stores))};
  }
  return {false, hull(here, coming.loads)};
}

AccessFlow::ByBase AccessFlow::follow(const Block& block, AccessChecks& checks) const {
  const std::vector<std::uint32_t> addresses = addresses_in(code_, block);
  // Backward first: what comes behind each access, in the block and beyond.
  std::vector<std::array<Ranges, 2>> coming_at(addresses.size());
  ByBase coming = behind_.at(block.begin);
  ByBase coming_in_block{};
  for (std::size_t n = addresses.size(); n-- > 0;) {
    const Instruction& i = code_.at(addresses[n])->instruction;
    if (is_access(i.op)) coming_at[n] = {coming[i.rs1], coming_in_block[i.rs1]};
    if (writes_x(i.op)) coming[i.rd] = coming_in_block[i.rd] = {};
    if (!is_access(i.op)) continue;
    if (writes_x(i.op) && i.rd == i.rs1) coming_at[n] = {};
    for (ByBase* ranges : {&coming, &coming_in_block}) {
      OffsetRange& range = is_store(i.op) ? (*ranges)[i.rs1].stores : (*ranges)[i.rs1].loads;
      range = hull(range, {offset_of(i), offset_of(i)});
    }
  }
  ByBase known = at_.at(block.begin).known;
  for (std::size_t n = 0; n < addresses.size(); ++n) {
    const Instruction& i = code_.at(addresses[n])->instruction;
    if (is_access(i.op)) {
      Ranges& ranges = known[i.rs1];
      if (!(is_store(i.op) ? ranges.stores : ranges.loads).contains(offset_of(i))) {
        const AccessCheck check = check_for(i, coming_at[n][0], coming_at[n][1]);
        checks[addresses[n]] = check;
        if (check.stores) ranges.stores = hull(ranges.stores, check.offsets);
        ranges.loads = hull(ranges.loads, check.offsets);
      }
    }
    if (!writes_x(i.op) || i.rd == 0) continue;
    const Copy copy = copy_of(i);
    const Ranges from = copy.is_copy ? known[copy.from] : Ranges{};
    known[i.rd] = {seen_from(from.loads, copy.added), seen_from(from.stores, copy.added)};
  }
  return known;
}

AccessChecks AccessFlow::checks(const Block& block) const {
  AccessChecks checks;
  follow(block, checks);
  return checks;
}

}  // namespace torolux::translated
