// SPDX-License-Identifier: MIT
// The queue of events: what few of them need. Pushed in any order, popped by (time, source, sequence number).
#include "emulator/time/event_queue.hpp"

#include <utility>

namespace torolux {

namespace {
constexpr std::size_t kChildren = 4;
/// Of as few as this, each is inserted in its turn.
constexpr std::size_t kFew = 16;
}  // namespace

/// The events of this time, the earliest of all, with what the heap has of it, in order.
void EventQueue::open(Cycles time) {
  now_ = near_ = time;
  if (time / kSpan != span_) advance(time / kSpan);
  popped_ = 0;
  open_ = true;
  opened_.clear();
  const std::size_t number = time % kWindow;
  for (std::uint32_t node = std::exchange(lists_[number], kNobody); node != kNobody;) {
    opened_.push_back(nodes_[node].event);
    const std::uint32_t next = std::exchange(nodes_[node].next, free_);
    free_ = std::exchange(node, next);
  }
  while (heap_least_ == time) opened_.push_back(pop_heap());
  filled_[number / kWord] &= ~(std::uint64_t{1} << (number % kWord));
  if (opened_.size() > 1) sort_opened();
}

void EventQueue::sort_opened() {
  if (opened_.size() > kFew) {
    std::ranges::sort(opened_, [](const Event& a, const Event& b) { return a.order < b.order; });
    return;
  }
  for (std::size_t i = 1; i < opened_.size(); ++i) {
    if (opened_[i - 1].order < opened_[i].order) continue;
    const Event event = opened_[i];
    std::size_t at = i;
    for (; at != 0 && event.order < opened_[at - 1].order; --at) opened_[at] = opened_[at - 1];
    opened_[at] = event;
  }
}

/// The earliest time after now_ with an event in a list.
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

// ---- Later spans ----

void EventQueue::push_far(const Event& event) {
  const std::uint64_t span = event.time / kSpan;
  if (event.time < now_ || span - span_ > kSpans + 1) return push_heap(event);
  const std::size_t number = span % kSpans;
  later_[number].push_back(event);
  later_filled_[number / kWord] |= std::uint64_t{1} << (number % kWord);
  later_least_ = std::min(later_least_, event.time);
}

/// now_ has come to this span; no event is left in those before.
void EventQueue::advance(std::uint64_t span) {
  const std::uint64_t dealt = std::exchange(span_, span) + 1;
  for (std::uint64_t s = std::max(span, dealt + 1); s <= span + 1; ++s) deal_out(s);
}

void EventQueue::deal_out(std::uint64_t span) {
  const std::size_t number = span % kSpans;
  std::vector<Event>& events = later_[number];
  if (events.empty()) return;
  for (const Event& event : events) {
    push_near(event.time) = event;
    if (watcher_ != nullptr) watcher_->soon(event);
  }
  events.clear();
  later_filled_[number / kWord] &= ~(std::uint64_t{1} << (number % kWord));
  later_least_ = least_of_later();
}

Cycles EventQueue::least_of_later() const {
  for (std::uint64_t span = span_ + 1; span <= span_ + 1 + kSpans; ++span) {
    const std::size_t number = span % kSpans;
    if ((later_filled_[number / kWord] >> (number % kWord) & 1U) == 0) continue;
    const auto least = std::ranges::min_element(later_[number], {}, &Event::time);
    return least->time;
  }
  return kNone;
}

// ---- The heap ----

void EventQueue::push_heap(const Event& event) {
  std::size_t at = heap_.size();
  heap_.push_back(event);
  while (at != 0) {
    const std::size_t parent = (at - 1) / kChildren;
    if (!before(event, heap_[parent])) break;
    heap_[at] = heap_[parent];
    at = parent;
  }
  heap_[at] = event;
  heap_least_ = heap_.front().time;
}

Event EventQueue::pop_heap() {
  const Event result = heap_.front();
  const Event last = heap_.back();
  heap_.pop_back();
  const std::size_t size = heap_.size();
  heap_least_ = kNone;
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
  heap_least_ = heap_.front().time;
  return result;
}

}  // namespace torolux
