// SPDX-License-Identifier: MIT
// A shadow call stack. Whose own cycles they are is known by the pc alone; who called, by the calling convention, and
// where a program does not keep to that, by the stack pointer.
#include "emulator/profile/pe_profile.hpp"

#include <algorithm>
#include <functional>

namespace torolux::profile {

void PeProfile::begin(const Place& place, const WaitCycles& waits) {
  charged_to_ = place.clock;
  waits_ = waits;
  push(place, kNowhere, false);
}

void PeProfile::charge(std::uint64_t clock) {
  if (frames_.empty()) return;
  tree_.at(top().node).self += clock - charged_to_;
  charged_to_ = clock;
}

void PeProfile::waited(const WaitCycles& waits) {
  if (frames_.empty()) return;
  CallNode& node = tree_.at(top().node);
  for (std::size_t i = 0; i < kWaitReasons; ++i) {
    node.waits[i] += waits[i] - waits_[i];
    charged_to_ += waits[i] - waits_[i];
  }
  waits_ = waits;
}

void PeProfile::push(const Place& now, std::uint32_t return_address, bool is_trap) {
  range_ = functions_->range_at(now.pc);
  const NodeNumber caller = frames_.empty() ? kRoot : top().node;
  const NodeNumber node = tree_.child_of(caller, range_.function);
  ++tree_.at(node).calls;
  frames_.push_back({node, range_.function, return_address, now.stack_pointer, is_trap});
}

/// The PE has gone to another function, which returns where this one would have. A jump into its middle is no call.
void PeProfile::replace(const Place& now) {
  range_ = functions_->range_at(now.pc);
  if (range_.function == top().function) return;
  const NodeNumber node = tree_.child_of(tree_.at(top().node).parent, range_.function);
  if (functions_->begins_at(now.pc)) ++tree_.at(node).calls;
  top().node = node;
  top().function = range_.function;
}

/// A function that is called again from the same place, with as much on the stack, was left without a return.
void PeProfile::forget_abandoned(std::uint32_t stack_pointer, std::uint32_t return_address) {
  for (std::size_t i = frames_.size(); i > 1 && frames_[i - 1].stack_pointer <= stack_pointer; --i) {
    if (frames_[i - 1].stack_pointer != stack_pointer || frames_[i - 1].return_address != return_address) continue;
    return frames_.resize(i - 1);
  }
}

/// False: nobody waits for a return to there.
bool PeProfile::return_to(const Place& now) {
  for (std::size_t i = frames_.size(); i > 1; --i) {
    if (frames_[i - 1].return_address != now.pc) continue;
    frames_.resize(i - 1);
    return true;
  }
  return false;
}

/// Back to a function that is not the one that called, as longjmp goes: the stack pointer tells to which call of it,
/// one that has something on the stack if there is such a one. None: it has another stack, or has not been called, and
/// nothing is left.
void PeProfile::jump_far(const Place& now) {
  const FunctionNumber target = functions_->range_at(now.pc).function;
  const auto call_with = [&](auto fits) {
    return std::find_if(frames_.rbegin(), frames_.rend(), [&](const Frame& frame) {
      return frame.function == target && fits(frame.stack_pointer, now.stack_pointer);
    });
  };
  auto found = call_with(std::greater<>());
  if (found == frames_.rend()) found = call_with(std::equal_to<>());
  if (found != frames_.rend()) frames_.resize(static_cast<std::size_t>(frames_.rend() - found));
}

void PeProfile::leave_trap() {
  const auto trap =
      std::find_if(frames_.rbegin(), frames_.rend() - 1, [](const Frame& frame) { return frame.is_trap; });
  if (trap != frames_.rend() - 1) frames_.resize(static_cast<std::size_t>(frames_.rend() - trap) - 1);
}

void PeProfile::passed_on(Flow flow, const Place& now, std::uint32_t link) {
  charge(now.clock);
  const CodeRange& target = functions_->range_at(now.pc);
  switch (flow) {
    case Flow::swap:
      return_to(now);
      [[fallthrough]];
    case Flow::call:
      // Within a function, what is not its beginning is no function.
      if (target.function == top().function && !functions_->begins_at(now.pc)) break;
      forget_abandoned(now.stack_pointer, link);
      return push(now, link, false);
    case Flow::back:
      if (return_to(now) || target.function == top().function) break;
      jump_far(now);
      break;
    case Flow::trap:
      return push(now, kNowhere, true);
    case Flow::trap_return:
      leave_trap();
      break;
    case Flow::on:
      // Its own return is that of the function that has jumped there.
      if (functions_->restores(target.function) && !functions_->restores(top().function))
        return push(now, kNowhere, false);
      break;
  }
  replace(now);
}

}  // namespace torolux::profile
