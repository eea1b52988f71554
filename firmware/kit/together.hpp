// SPDX-License-Identifier: MIT
// All PEs together: barrier, broadcast, reduce, by messages alone. Enters: each PE's bytes; leaves: what they make.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/kit/messenger.hpp"

namespace torolux::kit {

/// Joins `from` into `into`, value by value; both have the same length, whole values.
using Join = void (*)(std::span<std::byte> into, std::span<const std::byte> from);

/// One call. Every PE makes the same ones in the same order.
class Together {
 public:
  /// call: what the PE calls of the program's view, for which one of these does the work.
  Together(Messenger& messenger, Call call) : messenger_(messenger) { messenger.called_together(call); }

  void barrier();
  /// data: of the same length everywhere.
  void broadcast(std::uint32_t root, std::span<std::byte> data);
  /// To PE 0, then to root; elsewhere `data` is spoilt. Joined in the order of a binomial tree over the PEs' numbers.
  void reduce(std::uint32_t root, std::span<std::byte> data, Join join);
  void all_reduce(std::span<std::byte> data, Join join);

 private:
  struct Place {
    std::uint32_t column, row;
  };
  void dissemination(std::uint32_t place, std::uint32_t places, std::uint32_t first, std::uint32_t step);
  void broadcast_by_tree(std::uint32_t root, std::span<std::byte> data);
  void broadcast_by_chains(std::uint32_t root, std::span<std::byte> data);
  void reduce_to_first(std::span<std::byte> data, Join join);
  void send(std::uint32_t pe, std::span<const std::byte> data);
  void receive(std::uint32_t pe, std::span<std::byte> data);

  std::uint32_t columns() { return messenger_.niu().window().columns; }
  std::uint32_t rows() { return messenger_.niu().window().rows; }
  std::uint32_t pes() { return messenger_.niu().pes(); }
  std::uint32_t own() { return messenger_.niu().pe(); }
  /// Counted from the root, which is at (0, 0).
  Place place_from(std::uint32_t root, std::uint32_t pe);
  std::uint32_t pe_at(std::uint32_t root, Place place);

  Messenger& messenger_;
};

}  // namespace torolux::kit
