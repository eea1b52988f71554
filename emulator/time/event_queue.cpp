// SPDX-License-Identifier: MIT
// The queue of events: what few of them need. Pushed in any order, popped by (time, source, sequence number).
#include "emulator/time/event_queue.hpp"

#include <span>
#include <utility>

namespace torolux {

namespace {
constexpr std::size_t kChildren = 4;
/// Events of a time that each is moved by, on average, when they are put in order one by one: of more it is dear.
constexpr std::size_t kMostMoves = 8;
}  // namespace

/// A node that is of no list, and the only one.
std::uint32_t EventQueue::make_node() {
  nodes_.push_back({{}, kNobody});
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

/// The events of the time that has begun, with what the heap has of it, in order.
void EventQueue::open() {
  open_time_ = now_;
  popped_ = opened_end_ = 0;
  const std::size_t number = now_ % kWindow;
  for (std::uint32_t node = lists_[number]; node != kNobody;) {
    if (opened_end_ == opened_.size()) make_room();
    opened_[opened_end_++] = nodes_[node].event;
    const std::uint32_t next = std::exchange(nodes_[node].next, free_);
    free_ = std::exchange(node, next);
  }
  while (heap_least_ == now_) {
    if (opened_end_ == opened_.size()) make_room();
    opened_[opened_end_++] = pop_heap();
  }
  forget_list(number);
  if (opened_end_ > 1) sort_opened();
}

/// Mostly they were pushed in their order, and a list has the last one first.
void EventQueue::sort_opened() {
  const std::span<Event> events = std::span(opened_).first(opened_end_);
  std::ranges::reverse(events);
  std::size_t moves = 0;
  for (std::size_t i = 1; i < events.size(); ++i) {
    if (events[i - 1].order < events[i].order) continue;
    if (moves > kMostMoves * events.size()) {
      std::ranges::sort(events, {}, &Event::order);
      return;
    }
    const Event event = events[i];
    std::size_t at = i;
    for (; at != 0 && event.order < events[at - 1].order; --at) events[at] = events[at - 1];
    events[at] = event;
    moves += i - at;
  }
}

// ---- Later spans ----

void EventQueue::push_far(Cycles time, std::uint64_t order, std::uint64_t rest) {
  Event event{};
  fill(event, time, order, rest);
  next_ = std::min(next_, time);
  const std::uint64_t span = time / kSpan;
  if (time < now_ || span - span_ > kSpans + 1) return push_heap(event);
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
  if ((later_filled_[number / kWord] >> (number % kWord) & 1U) == 0) return;
  std::vector<Event>& events = later_[number];
  for (const Event& event : events) {
    push_near(event.time) = event;
    if (watcher_ != nullptr) watcher_->soon(event);
  }
  events.clear();
  later_filled_[number / kWord] &= ~(std::uint64_t{1} << (number % kWord));
  later_least_ = least_of_later();
}

Cycles EventQueue::least_of_later() const {
  // Those of a word that lie before the first are the last of all.
  const std::size_t first = (span_ + 1) % kSpans;
  std::size_t word = first / kWord;
  std::uint64_t bits = later_filled_[word] & (~std::uint64_t{0} << (first % kWord));
  for (std::size_t looked = 0; bits == 0; ++looked) {
    if (looked == later_filled_.size()) return kNone;
    word = (word + 1) % later_filled_.size();
    bits = later_filled_[word];
  }
  const std::size_t number = word * kWord + static_cast<std::size_t>(std::countr_zero(bits));
  return std::ranges::min_element(later_[number], {}, &Event::time)->time;
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

/// Earlier than what was popped last.
Event EventQueue::pop_earlier() {
  const Event result = pop_heap();
  next_ = std::min(open_time_ != kNone ? open_time_ : next_near(), std::min(later_least_, heap_least_));
  return result;
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
