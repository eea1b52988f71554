// SPDX-License-Identifier: MIT
// The queue of events: pushed in any order, popped by (time, source, sequence number).
#include "emulator/time/event_queue.hpp"

#include <algorithm>

namespace torolux {

namespace {
constexpr std::size_t kChildren = 4;
}

void EventQueue::push(Cycles time, std::uint32_t source, EventKind kind, std::uint16_t actor, std::uint8_t port,
                      std::uint32_t block) {
  const std::uint64_t order = (std::uint64_t{source} << 32U) | sequence_[source]++;
  const Event event{time, order, block, actor, port, kind};
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

Event EventQueue::pop() {
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
