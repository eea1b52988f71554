// SPDX-License-Identifier: MIT
// Three flows over the blocks of a function, each until nothing changes.
#include "emulator/engines/translated/generate/function_flow.hpp"

namespace torolux::translated {

FunctionFlow::FunctionFlow(const CodeMap& code, const Blocks& blocks, const Liveness& liveness,
                           const GuestFunction& function, bool resumes)
    : code_(code),
      blocks_(blocks),
      liveness_(liveness),
      function_(function),
      resumes_(resumes),
      at_([&function] {
        std::map<std::uint32_t, AtBlock> at;
        for (const std::uint32_t address : function.blocks) at[address] = {};
        return at;
      }()),
      accesses_(access_flow()) {
  const auto repeat = [&](auto update) {
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [address, sets] : at_) changed |= (this->*update)(blocks_.all().at(address));
    }
  };
  repeat(&FunctionFlow::update_dirty);
  for (bool changed = true; changed;) {  // against the flow of control, so few rounds suffice
    changed = false;
    for (auto at = at_.rbegin(); at != at_.rend(); ++at) changed |= update_needed(blocks_.all().at(at->first));
  }
  if (blocks.observed()) return;
  for (auto& [address, sets] : at_) sets.raw = kFloatRegisters;
  for (const std::uint32_t address : entered()) at_[address].raw = 0;
  repeat(&FunctionFlow::update_raw);
}

std::vector<std::uint32_t> FunctionFlow::successors(const Block& block) const {
  std::vector<std::uint32_t> found;
  const auto add = [&](std::uint32_t address) {
    if (inside(address)) found.push_back(address);
  };
  const bool goes_on = block.ending == Ending::next || block.ending == Ending::branch || block.ending == Ending::hint;
  if (goes_on) add(block.end);
  const bool jumps = block.ending == Ending::jump && code_.at(block.last)->instruction.rd == 0;
  if (jumps || block.ending == Ending::branch) add(block.target);
  return found;
}

AccessFlow FunctionFlow::access_flow() const {
  AccessFlow::Successors all;
  for (const auto& [address, sets] : at_) all[address] = successors(blocks_.all().at(address));
  return {code_, blocks_, all, entered()};
}

std::vector<std::uint32_t> FunctionFlow::entered() const {
  std::vector<std::uint32_t> entered;
  for (const auto& [address, sets] : at_) {
    const Block& block = blocks_.all().at(address);
    if (is_entry(block)) entered.push_back(address);
    const bool calls = block.ending == Ending::jump && code_.at(block.last)->instruction.rd != 0;
    if (calls && inside(block.end)) entered.push_back(block.end);
  }
  return entered;
}

std::vector<RegisterSet> FunctionFlow::saved(const Block& block) const {
  const std::vector<std::uint32_t> addresses = addresses_in(code_, block);
  std::vector<RegisterSet> sets(addresses.size() + 1);
  RegisterSet live = liveness_.behind(block);
  sets.back() = live;
  for (std::size_t n = addresses.size(); n-- > 0;) {
    live = liveness_.before(code_.at(addresses[n])->instruction, live);
    sets[n] = live;
  }
  RegisterSet dirty = this->dirty(block.begin);
  for (std::size_t n = 0; n < addresses.size(); ++n) {
    sets[n] &= dirty;
    dirty |= writes_of(code_.at(addresses[n])->instruction);
  }
  sets.back() &= dirty;
  return sets;
}

bool FunctionFlow::update_dirty(const Block& block) {
  RegisterSet dirty = at_[block.begin].dirty;
  for (const std::uint32_t pc : addresses_in(code_, block)) dirty |= writes_of(code_.at(pc)->instruction);
  bool changed = false;
  for (const std::uint32_t next : successors(block)) {
    RegisterSet& set = at_[next].dirty;
    changed |= (dirty & ~set) != 0;
    set |= dirty;
  }
  return changed;
}

bool FunctionFlow::update_needed(const Block& block) {
  const std::vector<std::uint32_t> addresses = addresses_in(code_, block);
  const std::vector<RegisterSet> saves = saved(block);
  std::string none;
  BlockWriter plan(code_, false, none);
  plan.begin(0, checks(block));
  RegisterSet needed = saves.back();  // leaves, for whatever reason: out of time, say
  for (const std::uint32_t next : successors(block)) needed |= at_[next].needed;
  for (std::size_t n = addresses.size(); n-- > 0;) {
    const Instruction& i = code_.at(addresses[n])->instruction;
    needed = (needed & ~writes_of(i)) | reads_of(i);
    if (plan.may_look(addresses[n])) needed |= saves[n];
  }
  RegisterSet& set = at_[block.begin].needed;
  const bool changed = needed != set;
  set = needed;
  return changed;
}

bool FunctionFlow::update_raw(const Block& block) {
  const std::vector<std::uint32_t> addresses = addresses_in(code_, block);
  std::string text;
  BlockWriter writer(code_, false, text);
  writer.begin(at_[block.begin].raw, {});
  for (const std::uint32_t pc : addresses) writer.write(code_.at(pc)->instruction, pc, {0, 0}, 0);
  bool changed = false;
  for (const std::uint32_t next : successors(block)) {
    RegisterSet& set = at_[next].raw;
    changed |= (set & ~writer.raw()) != 0;
    set &= writer.raw();
  }
  return changed;
}

RegisterSet FunctionFlow::to_canonicalize(const Block& block, RegisterSet raw) const {
  RegisterSet expected = 0;
  for (const std::uint32_t next : successors(block)) expected |= needed(next) & ~this->raw(next);
  return raw & expected;
}

}  // namespace torolux::translated
