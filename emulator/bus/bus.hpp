// SPDX-License-Identifier: MIT
// The system bus: requests enter; transfers leave one at a time, in turn among those whose request the arbiter sees.
#pragma once

#include <cstdint>
#include <vector>

#include "emulator/bus/bus_figures.hpp"
#include "emulator/description/description.hpp"
#include "emulator/time/event_queue.hpp"
#include "emulator/time/jitter.hpp"
#include "emulator/time/ready_set.hpp"
#include "emulator/torus/block.hpp"

namespace torolux {

/// Who may ask for the bus: the host, each PE's outgoing queue, each PE's divert buffer.
class BusRequester {
 public:
  static BusRequester host() { return BusRequester(0); }
  static BusRequester outgoing(unsigned pe) { return BusRequester(1 + 2 * pe); }
  static BusRequester divert(unsigned pe) { return BusRequester(2 + 2 * pe); }
  explicit BusRequester(std::uint32_t number) : number_(number) {}

  std::uint32_t number() const { return number_; }
  bool is_host() const { return number_ == 0; }
  bool is_divert() const { return number_ != 0 && number_ % 2 == 0; }
  unsigned pe() const { return (number_ - 1) / 2; }

 private:
  std::uint32_t number_;
};

/// What a requester asks for: a transfer for which there is room, or one to the frame buffer controller, whose places
/// the arbiter counts.
enum class BusRequest : std::uint8_t { none, room, frame_buffer };

/// What a requester that has the bus sends; `next`: whether its request stays up.
struct BusSend {
  BlockIndex block;
  BusRequest next;
};

class BusClient {
 public:
  virtual ~BusClient() = default;
  /// The requester has been granted the bus for what it asked for.
  virtual BusSend take(BusRequester requester, BusRequest granted) = 0;
};

/// A transfer of n bytes, header included, takes arbitration_cycles + ceil(n / bytes_per_cycle). The arbiter sees a new
/// request signal_cycles after it was made, and likewise a place that the frame buffer controller has freed. It decides
/// at the end of a cycle, among all requests that it sees by then.
class Bus {
 public:
  /// source, arbiter: of events; the arbiter's sorts after all others.
  Bus(unsigned pes, const MachineDescription& machine, const Jitter& jitter, EventQueue& events, std::uint32_t source,
      std::uint32_t arbiter, BlockPool& pool, BusClient& client);

  /// The requester's request goes up; one that is up stays as it is.
  void request(BusRequester requester, BusRequest what, Cycles now);
  /// The frame buffer controller has freed a place.
  void free_place(Cycles now);
  /// Kinds bus_request, bus_place, bus_arbitrate.
  void handle(const Event& event);
  /// The transfer of Event bus_done has ended: the bus is free.
  void transfer_done(Cycles now);

  bool busy() const { return busy_; }
  /// Of the transfer that has ended last, or is under way.
  BusKind kind() const { return kind_; }
  const BusFigures& figures() const { return figures_; }
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(requests_, room_, frame_buffer_, places_, next_, busy_, scheduled_, figures_, kind_);
  }

 private:
  void see(std::uint32_t requester, Cycles now);
  void see_place(Cycles now);
  void schedule(Cycles now);
  std::size_t next_in_turn() const;
  void grant(std::uint32_t requester, Cycles now);
  Cycles count(BusRequester requester, const Block& block);
  void set_seen(std::uint32_t requester, BusRequest what);

  std::uint32_t bytes_per_cycle_, arbitration_cycles_, signal_cycles_;
  Jitter jitter_;
  EventQueue& events_;
  std::uint32_t source_, arbiter_;
  BlockPool& pool_;
  BusClient& client_;
  std::vector<BusRequest> requests_;  // by requester, as it has them
  ReadySet room_, frame_buffer_;      // requests that the arbiter sees
  std::uint32_t places_;              // of the frame buffer controller, free as far as the arbiter knows
  std::uint32_t requesters_;
  std::uint32_t next_ = 0;  // round robin
  bool busy_ = false;
  bool scheduled_ = false;  // a bus_arbitrate of this cycle
  BusFigures figures_;
  BusKind kind_ = BusKind::load;
};

}  // namespace torolux
