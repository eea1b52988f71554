// SPDX-License-Identifier: MIT
// The system bus: one transfer at a time, in turn among those that are ready.
#pragma once

#include <cstdint>

#include "emulator/machine/description.hpp"
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

class BusClient {
 public:
  virtual ~BusClient() = default;
  /// The requester has been granted the bus: gives what it sends, and has reserved room for it where it goes.
  virtual BlockIndex take(BusRequester requester, Cycles now) = 0;
};

/// A transfer of n bytes, header included, takes arbitration_cycles + ceil(n / bytes_per_cycle).
class Bus {
 public:
  Bus(unsigned pes, const MachineDescription::Bus& parameters, const Jitter& jitter, EventQueue& events,
      std::uint32_t source, BlockPool& pool, BusClient& client);

  /// ready: it has something to send, and room for it where it goes. `try_grant` is to follow.
  void set_ready(BusRequester requester, bool ready);
  /// Grants the bus if it is free and someone is ready.
  void try_grant(Cycles now);
  /// The transfer of Event bus_done has ended: the bus is free.
  void transfer_done() { busy_ = false; }

  bool busy() const { return busy_; }
  Cycles busy_cycles() const { return busy_cycles_; }
  std::uint64_t transfers() const { return transfers_; }

 private:
  std::uint32_t bytes_per_cycle_, arbitration_cycles_;
  Jitter jitter_;
  EventQueue& events_;
  std::uint32_t source_;
  BlockPool& pool_;
  BusClient& client_;
  ReadySet ready_;  // requesters
  std::uint32_t requesters_;
  std::uint32_t next_ = 0;  // round robin
  bool busy_ = false;
  Cycles busy_cycles_ = 0;
  std::uint64_t transfers_ = 0;
};

}  // namespace torolux
