// SPDX-License-Identifier: MIT
// Backward: what may still be accessed by a register's present value. Forward: what has been checked on every way.
#include "emulator/engines/translated/analysis/access_flow.hpp"

#include <algorithm>

#include "emulator/engines/translated/decode/instruction.hpp"

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

void add_access(const Instruction& i, OffsetRange& loads, OffsetRange& stores) {
  OffsetRange& range = is_store(i.op) ? stores : loads;
  range = hull(range, {offset_of(i), offset_of(i)});
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
                       const std::vector<std::uint32_t>& entered) {
  for (const auto& [address, next] : successors) at_[address].steps = steps_of(code, blocks.all().at(address));
  for (bool changed = true; changed;) {
    changed = false;
    for (auto found = successors.rbegin(); found != successors.rend(); ++found) {
      changed |= update_coming(at_.at(found->first), found->second);
    }
  }
  for (const auto& [address, next] : successors) note_coming(at_.at(address), coming_behind(next));
  for (const std::uint32_t address : entered) at_[address].reached = true;
  constexpr unsigned kPatience = 8;  // what still shrinks after so many rounds, a few bytes each time, is given up
  unsigned rounds = 0;
  for (bool changed = true; changed; ++rounds) {
    changed = false;
    for (const auto& [address, next] : successors) {
      changed |= update_known(at_.at(address), next, rounds >= kPatience);
    }
  }
  for (const auto& [address, block] : at_) follow(block, &checks_[address]);
}

std::vector<AccessFlow::Step> AccessFlow::steps_of(const CodeMap& code, const Block& block) const {
  std::vector<Step> steps;
  for (const std::uint32_t address : addresses_in(code, block)) {
    const Instruction& i = code.at(address)->instruction;
    const bool matters = is_access(i.op) || (writes_x(i.op) && i.rd != 0);
    if (matters) steps.push_back({&i, address, {}, {}});
  }
  return steps;
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

bool AccessFlow::update_coming(AtBlock& block, const std::vector<std::uint32_t>& successors) {
  ByBase coming = coming_behind(successors);
  for (auto step = block.steps.rbegin(); step != block.steps.rend(); ++step) {
    const Instruction& i = *step->instruction;
    if (writes_x(i.op)) coming[i.rd] = {};
    if (is_access(i.op)) add_access(i, coming[i.rs1].loads, coming[i.rs1].stores);
  }
  const bool changed = block.coming != coming;
  block.coming = coming;
  return changed;
}

/// coming: behind the block.
void AccessFlow::note_coming(AtBlock& block, ByBase coming) const {
  ByBase coming_in_block{};
  for (auto step = block.steps.rbegin(); step != block.steps.rend(); ++step) {
    const Instruction& i = *step->instruction;
    if (writes_x(i.op)) coming[i.rd] = coming_in_block[i.rd] = {};
    if (!is_access(i.op)) continue;
    step->coming = coming[i.rs1];
    step->coming_in_block = coming_in_block[i.rs1];
    for (ByBase* ranges : {&coming, &coming_in_block}) add_access(i, (*ranges)[i.rs1].loads, (*ranges)[i.rs1].stores);
  }
}

bool AccessFlow::update_known(AtBlock& block, const std::vector<std::uint32_t>& successors, bool widen) {
  if (!block.reached) return false;
  const ByBase known = follow(block, nullptr);
  bool changed = false;
  for (const std::uint32_t next : successors) {
    AtBlock& there = at_.at(next);
    if (!there.reached) {
      there.reached = changed = true;
      there.known = known;
      continue;
    }
    for (unsigned n = 1; n < known.size(); ++n) {
      const Ranges both{common(there.known[n].loads, known[n].loads), common(there.known[n].stores, known[n].stores)};
      if (both == there.known[n]) continue;
      there.known[n] = widen ? Ranges{} : both;
      changed = true;
    }
  }
  return changed;
}

AccessCheck AccessFlow::check_for(const Step& step) {
  const Instruction& i = *step.instruction;
  const OffsetRange here{offset_of(i), offset_of(i)};
  // A check for stores covers loads, too. But a way that only loads may have to do with constants.
  if (is_store(i.op) || !step.coming_in_block.stores.empty()) {
    return {true, hull(here, hull(step.coming.loads, step.coming.stores))};
  }
  return {false, hull(here, step.coming.loads)};
}

AccessFlow::ByBase AccessFlow::follow(const AtBlock& block, AccessChecks* checks) {
  ByBase known = block.known;
  for (const Step& step : block.steps) {
    const Instruction& i = *step.instruction;
    if (is_access(i.op)) {
      Ranges& ranges = known[i.rs1];
      if (!(is_store(i.op) ? ranges.stores : ranges.loads).contains(offset_of(i))) {
        const AccessCheck check = check_for(step);
        if (checks != nullptr) (*checks)[step.address] = check;
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

}  // namespace torolux::translated
