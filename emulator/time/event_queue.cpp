// SPDX-License-Identifier: MIT
// The queue of events: pushed in any order, popped by (time, source, sequence number).
#include "emulator/time/event_queue.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace torolux {

namespace {
constexpr std::size_t kChildren = 4;
}

void EventQueue::push(Cycles time, std::uint32_t source, EventKind kind, std::uint16_t actor, std::uint8_t port,
                      std::uint32_t block) {
  const std::uint64_t order = (std::uint64_t{source} << 32U) | sequence_[source]++;
  const bool far = time - now_ >= kWindow;  // earlier ones too: the difference wraps
  if (!far && !(open_ && time == now_)) {
    Node& node = push_near(time);
    node.event = {time, order, block, actor, port, kind};
    return;
  }
  const Event event{time, order, block, actor, port, kind};
  return far ? push_far(event) : push_open(event);
}

/// Among the events of this cycle that have not gone yet.
void EventQueue::push_open(const Event& event) {
  opened_.push_back(event);
  std::size_t at = opened_.size() - 1;
  for (; at > popped_ && event.order < opened_[at - 1].order; --at) opened_[at] = opened_[at - 1];
  opened_[at] = event;
}

/// A place for an event of this time, to be filled where it stands.
EventQueue::Node& EventQueue::push_near(Cycles time) {
  std::uint32_t node = free_;
  if (node == kNobody) {
    node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
  } else {
    free_ = nodes_[node].next;
  }
  const std::size_t number = time % kWindow;
  nodes_[node].next = lists_[number];
  lists_[number] = node;
  filled_[number / kWord] |= std::uint64_t{1} << (number % kWord);
  near_ = std::min(near_, time);
  return nodes_[node];
}

Event EventQueue::pop() {
  const Cycles time = next_time();
  if (time < now_) return pop_far();
  if (!open_) open(time);
  const Event result = opened_[popped_++];
  if (popped_ == opened_.size()) {
    open_ = false;
    near_ = next_near();
  }
  return result;
}

/// The events of this time, the earliest of all, with what the heap has of it, in order.
void EventQueue::open(Cycles time) {
  now_ = near_ = time;
  popped_ = 0;
  open_ = true;
  opened_.clear();
  const std::size_t number = time % kWindow;
  for (std::uint32_t node = std::exchange(lists_[number], kNobody); node != kNobody;) {
    opened_.push_back(nodes_[node].event);
    const std::uint32_t next = std::exchange(nodes_[node].next, free_);
    free_ = std::exchange(node, next);
  }
  while (!heap_.empty() && heap_.front().time == time) opened_.push_back(pop_far());
  filled_[number / kWord] &= ~(std::uint64_t{1} << (number % kWord));
  if (opened_.size() > 1) {
    std::ranges::sort(opened_, [](const Event& a, const Event& b) { return a.order < b.order; });
  }
}

/// The earliest time after now_ with an event in a bucket.
Cycles EventQueue::next_near() const {
  const std::size_t first = (now_ + 1) % kWindow;
  std::size_t word = first / kWord;
  std::uint64_t bits = filled_[word] & (~std::uint64_t{0} << (first % kWord));
  for (std::size_t looked = 0; bits == 0; ++looked) {
    if (looked == filled_.size()) return kNone;
    word = (word + 1) % filled_.size();
    bits = filled_[word];
  }
  const std::size_t number = word * kWord + static_cast<std::size_t>(std::countr_zero(bits));
  return now_ + 1 + (number + kWindow - first) % kWindow;
}

void EventQueue::push_far(const Event& event) {
  std::size_t at = heap_.size();
  heap_.push_back(event);
  while (at != 0) {
    const std::size_t parent = (at - 1) / kChildren;
    if (!before(event, heap_[parent])) break;
    heap_[at] = heap_[parent];
    at = parent;
  }
  heap_[at] = event;
}

Event EventQueue::pop_far() {
  const Event result = heap_.front();
  const Event last = heap_.back();
  heap_.pop_back();
  const std::size_t size = heap_.size();
  if (size == 0) return result;
  std::size_t at = 0;
  for (;;) {
    const std::size_t first = at * kChildren + 1;
    if (first >= size) break;
    std::size_t least = first;
    for (std::size_t child = first + 1; child < std::min(first + kChildren, size); ++child) {
      if (before(heap_[child], heap_[least])) least = child;
    }
    if (!before(heap_[least], last)) break;
    heap_[at] = heap_[least];
    at = least;
  }
  heap_[at] = last;
  return result;
}

}  // namespace torolux
