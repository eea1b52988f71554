// SPDX-License-Identifier: MIT
// Patterns of synthetic traffic: a name and a sender in, a destination out.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/torus/shape.hpp"

namespace torolux {

class TrafficPattern {
 public:
  virtual ~TrafficPattern() = default;
  /// Where `from` sends to; `random`: uniform, 32 bits, for patterns by chance. May be `from` itself.
  virtual unsigned destination(unsigned from, std::uint32_t random) const = 0;
  /// How many nodes send to the one that most send to, on average.
  virtual unsigned senders_to_one() const { return 1; }
};

/// uniform, tornado, transpose, bit-complement, hotspot.
const std::vector<std::string_view>& traffic_pattern_names();

/// to_itself: whether a node may send to itself; else `uniform` leaves it out. Throws UsageError for a name that is
/// none, InputError for a torus that the pattern does not fit.
std::unique_ptr<TrafficPattern> make_traffic_pattern(std::string_view name, TorusShape shape, bool to_itself);

}  // namespace torolux
