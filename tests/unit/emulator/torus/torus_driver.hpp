// SPDX-License-Identifier: MIT
// Synthetic traffic straight on the torus: a pattern, a rate and packet sizes in, latencies and throughput out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "emulator/torus/torus.hpp"

namespace torolux::test {

/// A torus alone: every packet is taken at once where it leaves, every one offered waits in an unbounded queue.
class TorusDriver final : private TorusClient {
 public:
  TorusDriver(unsigned columns, unsigned rows, const MachineDescription::Torus& parameters, std::uint32_t jitter = 0)
      : events_(3 * std::size_t{columns} * rows),
        torus_(TorusShape(columns, rows), parameters, Jitter(1, jitter), events_,
               {.routers = columns * rows, .arbiters = 2 * columns * rows}, pool_, *this) {}

  struct Delivery {
    Cycles sent, delivered;
    std::uint16_t source, destination;
    std::uint32_t number, hops, flits;
  };
  std::function<void(const Delivery&)> on_delivery;

  Torus& torus() { return torus_; }
  BlockPool& pool() { return pool_; }
  Cycles now() const { return now_; }
  std::uint64_t dropped() const { return dropped_; }  ///< copies with a bad CRC that came to their destination

  /// The packet is offered at `when`, which is not before now.
  void send(unsigned from, unsigned to, std::uint32_t flits, Cycles when) {
    const BlockIndex index = pool_.take();
    Block& block = pool_[index];
    block.source = static_cast<std::uint16_t>(from);
    block.destination = static_cast<std::uint16_t>(to);
    block.flits = flits;
    constexpr std::array<std::byte, 16> kContents{};
    pool_.set_payload(index, kContents);
    events_.push(when, from, EventKind::command, static_cast<std::uint16_t>(from), 0, index);
  }

  /// The lower half of the number of the next packet from there: chance is a hash of numbers.
  void set_next_number(unsigned from, std::uint32_t number) { sent_[from] = number; }

  /// Handles all events before `until`, or all there are. Returns their number.
  std::uint64_t run(Cycles until = ~Cycles{0}) {
    std::uint64_t handled = 0;
    while (events_.next_time() < until) {
      const Event event = events_.pop();
      if (event.time < now_) throw std::logic_error("time runs backwards");
      now_ = event.time;
      ++handled;
      if (event.kind == EventKind::command) {
        std::uint64_t& number = pool_[event.block].number;
        number = (std::uint64_t{event.actor} << 32U) | sent_[event.actor]++;  // in the order of being offered
        offered_[number] = now_;
        torus_.inject(event.actor, event.block, now_);
      } else if (event.kind == EventKind::deliver) {
        deliver(event.block);
      } else {
        torus_.handle(event);
      }
    }
    return handled;
  }

 private:
  void injected(unsigned /*pe*/, Cycles /*tail*/) override {}
  bool accept(unsigned /*pe*/, BlockIndex /*block*/) override { return true; }
  void deliver(BlockIndex index) {
    const Block& block = pool_[index];
    if (block.copy != Copy::good) {
      ++dropped_;
      return pool_.give_back(index);
    }
    const auto found = offered_.find(block.number);
    if (found == offered_.end()) throw std::logic_error("a packet has arrived twice");
    if (on_delivery) {
      on_delivery({found->second, now_, block.source, block.destination, static_cast<std::uint32_t>(block.number),
                   block.hops, block.flits});
    }
    offered_.erase(found);
    pool_.give_back(index);
  }

  EventQueue events_;
  BlockPool pool_;
  Torus torus_;
  Cycles now_ = 0;
  std::uint64_t dropped_ = 0;
  std::map<unsigned, std::uint32_t> sent_;
  std::unordered_map<std::uint64_t, Cycles> offered_;  // by packet number
};

}  // namespace torolux::test
