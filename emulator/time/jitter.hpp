// SPDX-License-Identifier: MIT
// Delays that shake the order of events: a seed and what is to be delayed in, cycles out, the same in every run.
#pragma once

#include <cstdint>

#include "firmware/protocol/random.hpp"

namespace torolux {

class Jitter {
 public:
  enum class What : std::uint32_t { link = 1, router, bus };

  /// seed 0: no delays. most: the longest [cycles].
  Jitter(std::uint32_t seed, std::uint32_t most) : seed_(seed), most_(seed == 0 ? 0 : most) {}

  bool none() const { return most_ == 0; }
  /// 0..most, by a hash of what for: a packet's number and the links it has crossed, or a transfer's number.
  std::uint64_t delay(What what, std::uint64_t number, std::uint32_t step = 0) const {
    if (most_ == 0) return 0;
    std::uint32_t key = protocol::hash_combine(seed_, static_cast<std::uint32_t>(what));
    key = protocol::hash_combine(key, static_cast<std::uint32_t>(number));
    key = protocol::hash_combine(key, static_cast<std::uint32_t>(number >> 32U));
    return protocol::hash_combine(key, step) % (std::uint64_t{most_} + 1);
  }

 private:
  std::uint32_t seed_;
  std::uint32_t most_;
};

}  // namespace torolux
