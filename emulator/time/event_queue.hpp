// SPDX-License-Identifier: MIT
// Events of the machine, and the queue from which they leave in order of (time, source, sequence number).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace torolux {

using Cycles = std::uint64_t;  ///< virtual time

enum class EventKind : std::uint8_t {
  command,        ///< actor: PE, port, block: PendingCommand. It takes effect
  arrive,         ///< actor: router, port: input, block: a packet's head has come
  advanced,       ///< actor: router, port: input, block: Advance. The same of one that has gone ahead without events
  head,           ///< actor: router, port: input. Its next packet may ask for an output
  tail,           ///< actor: router, port: input, block: the tail of a packet with a bad CRC has come
  line,           ///< actor: first router of a ring, port: output, block: 1 raised, 0 not; all of the ring see it
  arbitrate,      ///< actor: router, port: output. Comes last in its cycle
  deliver,        ///< actor: PE, block: a packet has left the torus
  copied,         ///< actor: PE, port: 1 from the bus, block: a packet lies in its record slots
  bus_request,    ///< block: requester. The arbiter sees its request
  bus_place,      ///< the arbiter sees a freed place of the frame buffer controller
  bus_arbitrate,  ///< at the end of a cycle
  bus_done,       ///< block: a transfer has ended
  slots_asked,    ///< actor: PE, port: HostQueue. Its NIU sees that the host wants record slots
  slots_granted,  ///< actor: PE, port: HostQueue. The host sees that they are reserved
  control_free,   ///< actor: PE. The host sees that a control buffer is free
  host_queue,     ///< actor: PE or kEveryPe, block: something that the host has made is ready for the bus
  host_step,      ///< the host takes its next message
  pixels_done,    ///< the frame buffer controller has added a message's pixels
};

/// Whether it tells how a packet travels: what comes of that are its deliveries.
constexpr bool is_inside_torus(EventKind kind) {
  return kind >= EventKind::arrive && kind <= EventKind::arbitrate;
}

struct Event {
  Cycles time;
  std::uint64_t order;  ///< source in the upper half, its sequence number in the lower
  std::uint32_t block;
  std::uint16_t actor;
  std::uint8_t port;
  EventKind kind;
};
static_assert(sizeof(Event) == 24);

/// Told of an event some time before it leaves the queue, so that what it needs may be fetched into the caches
/// meanwhile.
class EventWatcher {
 public:
  virtual ~EventWatcher() = default;
  /// Of each event that was pushed long before its time, once it is at most 2 * EventQueue::kSpan cycles ahead.
  virtual void soon(const Event& event) = 0;
};

/// A list for each of the next cycles, which is put in order when its time comes; behind them a list for each span of
/// cycles, dealt out to the cycles when the span before it begins; a heap of four children per node for what is later
/// still, or earlier than what has been popped. The lists' nodes are used again last in, first out, so they stay in the
/// caches.
class EventQueue {
 public:
  static constexpr Cycles kNone = ~Cycles{0};
  static constexpr Cycles kSpan = 256;

  /// sources: actors that make events, numbered from 0.
  explicit EventQueue(std::size_t sources) : later_(kSpans), sequence_(sources, 0) { lists_.fill(kNobody); }

  /// watcher: outlives this, or nullptr.
  void watch(EventWatcher* watcher) { watcher_ = watcher; }
  bool empty() const { return next_ == kNone; }
  /// Of the event that comes next; kNone: there is none.
  Cycles next_time() const { return next_; }
  void push(Cycles time, std::uint32_t source, EventKind kind, std::uint16_t actor, std::uint8_t port,
            std::uint32_t block) {
    const std::uint64_t order = (std::uint64_t{source} << 32U) | sequence_[source]++;
    const std::uint64_t rest =
        block | std::uint64_t{actor} << 32U | std::uint64_t{port} << 48U | static_cast<std::uint64_t>(kind) << 56U;
    if (time - now_ >= window_) return push_far(time, order, rest);  // an earlier time: the difference wraps
    fill(time == open_time_ ? push_open(order) : push_near(time), time, order, rest);
  }
  /// Only if there is one.
  Event pop() {
    if (next_ < now_) return pop_earlier();
    if (next_ != open_time_) {
      begin(next_);
      const std::uint32_t node = lists_[now_ % kWindow];
      if (node != kNobody && nodes_[node].next == kNobody && heap_least_ != now_) return pop_alone(node);
      open();
    }
    const Event result = opened_[popped_++];
    if (popped_ == opened_end_) close();
    return result;
  }
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(lists_, filled_, nodes_, free_, open_time_, now_, span_, window_, next_, later_least_, heap_least_, popped_,
            opened_end_, opened_, later_, later_filled_, heap_, sequence_);
    filled_words_ = 0;
    for (std::size_t word = 0; word < kWords; ++word) filled_words_ |= (filled_[word] != 0 ? 1U : 0U) << word;
  }

 private:
  static constexpr std::size_t kWindow = 2 * kSpan;
  static constexpr std::size_t kSpans = 128;  // beyond the window
  static constexpr std::size_t kWord = 64;
  static constexpr std::size_t kWords = kWindow / kWord;
  static_assert(2 * kWords <= 32);
  static constexpr std::uint32_t kNobody = ~std::uint32_t{0};
  static constexpr std::size_t kLeastRoom = 64;
  struct Node {
    Event event;
    std::uint32_t next;
  };

  static bool before(const Event& a, const Event& b) { return a.time != b.time ? a.time < b.time : a.order < b.order; }
  /// In as few stores as there are loads when it is copied: a load of what several stores have just written waits for
  /// all of them.
  static void fill(Event& event, Cycles time, std::uint64_t order, std::uint64_t rest) {
    static_assert(std::endian::native == std::endian::little && offsetof(Event, block) == 16 &&
                  offsetof(Event, actor) == 20 && offsetof(Event, port) == 22 && offsetof(Event, kind) == 23);
    event.time = time;
    event.order = order;
    std::memcpy(reinterpret_cast<std::byte*>(&event) + offsetof(Event, block), &rest, sizeof rest);
  }

  /// Places for an event of this order in the cycle that is open, or of this time in a list; to be filled.
  Event& push_open(std::uint64_t order) {
    if (opened_end_ == opened_.size()) make_room();
    std::size_t at = opened_end_++;
    for (; at > popped_ && order < opened_[at - 1].order; --at) opened_[at] = opened_[at - 1];
    return opened_[at];
  }
  Event& push_near(Cycles time) {
    std::uint32_t node = free_;
    if (node == kNobody) node = make_node();
    free_ = nodes_[node].next;
    const std::size_t number = time % kWindow;
    nodes_[node].next = lists_[number];
    lists_[number] = node;
    filled_[number / kWord] |= std::uint64_t{1} << (number % kWord);
    filled_words_ |= 1U << (number / kWord);
    next_ = std::min(next_, time);
    return nodes_[node].event;
  }
  /// The earliest time of all has come.
  void begin(Cycles time) {
    now_ = time;
    if (time / kSpan != span_) advance(time / kSpan);
    window_ = (span_ + 2) * kSpan - time;
  }
  /// Nobody else has its time: it need not be put in order. What it makes for the same time is alone in turn.
  Event pop_alone(std::uint32_t node) {
    forget_list(now_ % kWindow);
    nodes_[node].next = free_;
    free_ = node;
    close();
    return nodes_[node].event;
  }
  /// The list of this number becomes empty.
  void forget_list(std::size_t number) {
    lists_[number] = kNobody;
    std::uint64_t& word = filled_[number / kWord];
    word &= ~(std::uint64_t{1} << (number % kWord));
    if (word == 0) filled_words_ &= ~(1U << (number / kWord));
  }
  void close() {
    open_time_ = kNone;
    next_ = std::min(next_near(), std::min(later_least_, heap_least_));
  }
  /// The earliest time from now_ on with an event in a list.
  Cycles next_near() const {
    const std::size_t first = now_ % kWindow;
    std::size_t word = first / kWord;
    const std::uint64_t bits = filled_[word] >> (first % kWord);
    if (bits != 0) return now_ + static_cast<Cycles>(std::countr_zero(bits));
    if (filled_words_ == 0) return kNone;
    // From the next word on, the one in which now_ is last: what it has left lies before now_ in the window.
    const std::uint32_t twice = filled_words_ | filled_words_ << kWords;
    word = (word + 1 + static_cast<std::size_t>(std::countr_zero(twice >> (word + 1)))) % kWords;
    const std::size_t number = word * kWord + static_cast<std::size_t>(std::countr_zero(filled_[word]));
    return now_ + (number - first) % kWindow;
  }
  std::uint32_t make_node();
  void make_room() { opened_.resize(2 * opened_.size() + kLeastRoom); }
  void push_far(Cycles time, std::uint64_t order, std::uint64_t rest);
  void push_heap(const Event& event);
  Event pop_heap();
  Event pop_earlier();
  void open();
  void sort_opened();
  void advance(std::uint64_t span);
  void deal_out(std::uint64_t span);
  Cycles least_of_later() const;

  std::array<std::uint32_t, kWindow> lists_;    // [time % kWindow], for times from now_ to the next span's end
  std::array<std::uint64_t, kWords> filled_{};  // a bit for each list that is not empty
  std::uint32_t filled_words_ = 0;              // a bit for each of these words that is not 0
  std::vector<Node> nodes_;                     // of lists
  std::uint32_t free_ = kNobody;                // nodes that are of none
  Cycles open_time_ = kNone;                    // now_, while opened_ holds what is left of it
  Cycles now_ = 0;                              // of the last event popped that was not from the heap alone
  std::uint64_t span_ = 0;                      // now_ / kSpan
  Cycles window_ = kWindow;                     // from now_ to (span_ + 2) * kSpan: lists_ are for these times
  Cycles next_ = kNone;                         // earliest time with an event
  Cycles later_least_ = kNone;                  // the same of later_ and heap_
  Cycles heap_least_ = kNone;
  std::size_t popped_ = 0, opened_end_ = 0;                   // of opened_, those that have gone, and all
  std::vector<Event> opened_;                                 // those of open_time_, in order; then room for more
  std::vector<std::vector<Event>> later_;                     // [time / kSpan % kSpans], for the spans behind lists_
  std::array<std::uint64_t, kSpans / kWord> later_filled_{};  // a bit for each that is not empty
  std::vector<Event> heap_;
  std::vector<std::uint32_t> sequence_;  // per source
  EventWatcher* watcher_ = nullptr;
};

}  // namespace torolux
