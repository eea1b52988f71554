// SPDX-License-Identifier: MIT
// The system bus: arbitration in turn, and the time of a transfer.
#include "emulator/bus/bus.hpp"

#include <bit>

#include "firmware/protocol/niu_window.hpp"

namespace torolux {

namespace {
constexpr std::uint32_t kNobodyReady = 0xFFFF'FFFFU;
}

Bus::Bus(unsigned pes, const MachineDescription::Bus& parameters, EventQueue& events, std::uint32_t source,
         BlockPool& pool, BusClient& client)
    : bytes_per_cycle_(parameters.bytes_per_cycle),
      arbitration_cycles_(parameters.arbitration_cycles),
      events_(events),
      source_(source),
      pool_(pool),
      client_(client),
      ready_((1 + 2 * pes + 63) / 64),
      requesters_(1 + 2 * pes) {}

void Bus::set_ready(BusRequester requester, bool ready) {
  const std::uint64_t bit = std::uint64_t{1} << (requester.number() % 64);
  std::uint64_t& word = ready_[requester.number() / 64];
  word = ready ? word | bit : word & ~bit;
}

/// The first that is ready from next_ on, around the end.
std::uint32_t Bus::next_ready() const {
  const std::size_t words = ready_.size();
  const std::size_t first = next_ / 64;
  for (std::size_t i = 0; i <= words; ++i) {
    const std::size_t word = (first + i) % words;
    std::uint64_t bits = ready_[word];
    const std::uint64_t below = (std::uint64_t{1} << (next_ % 64)) - 1;
    if (i == 0) bits &= ~below;
    if (i == words) bits &= below;
    if (bits != 0) return static_cast<std::uint32_t>(word * 64) + static_cast<std::uint32_t>(std::countr_zero(bits));
  }
  return kNobodyReady;
}

void Bus::try_grant(Cycles now) {
  if (busy_) return;
  const std::uint32_t number = next_ready();
  if (number == kNobodyReady) return;
  next_ = (number + 1) % requesters_;
  busy_ = true;
  const BlockIndex block = client_.take(BusRequester(number), now);
  const std::uint32_t bytes = pool_[block].bytes + static_cast<std::uint32_t>(sizeof(protocol::MessageHeader));
  const Cycles duration = arbitration_cycles_ + (bytes + bytes_per_cycle_ - 1) / bytes_per_cycle_;
  busy_cycles_ += duration;
  ++transfers_;
  events_.push(now + duration, source_, EventKind::bus_done, 0, 0, block);
}

}  // namespace torolux
