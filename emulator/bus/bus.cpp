// SPDX-License-Identifier: MIT
// The system bus: arbitration in turn, and the time of a transfer.
#include "emulator/bus/bus.hpp"

#include "firmware/protocol/niu_window.hpp"

namespace torolux {

Bus::Bus(unsigned pes, const MachineDescription::Bus& parameters, const Jitter& jitter, EventQueue& events,
         std::uint32_t source, BlockPool& pool, BusClient& client)
    : bytes_per_cycle_(parameters.bytes_per_cycle),
      arbitration_cycles_(parameters.arbitration_cycles),
      jitter_(jitter),
      events_(events),
      source_(source),
      pool_(pool),
      client_(client),
      ready_(1 + std::size_t{2} * pes),
      requesters_(1 + 2 * pes) {}

void Bus::set_ready(BusRequester requester, bool ready) {
  ready_.set(requester.number(), ready);
}

void Bus::try_grant(Cycles now) {
  if (busy_) return;
  const std::size_t found = ready_.next(next_);
  if (found == ReadySet::kNobody) return;
  const auto number = static_cast<std::uint32_t>(found);
  next_ = (number + 1) % requesters_;
  busy_ = true;
  const BlockIndex block = client_.take(BusRequester(number), now);
  const std::uint32_t bytes = pool_[block].bytes + static_cast<std::uint32_t>(sizeof(protocol::MessageHeader));
  const Cycles duration = arbitration_cycles_ + (bytes + bytes_per_cycle_ - 1) / bytes_per_cycle_ +
                          jitter_.delay(Jitter::What::bus, transfers_);
  busy_cycles_ += duration;
  ++transfers_;
  events_.push(now + duration, source_, EventKind::bus_done, 0, 0, block);
}

}  // namespace torolux
