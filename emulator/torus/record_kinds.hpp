// SPDX-License-Identifier: MIT
// What kinds of records there are, for who counts them: a record enters, the number of its kind leaves.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace torolux {

class RecordKinds {
 public:
  static constexpr std::size_t kUnknown = std::numeric_limits<std::size_t>::max();

  virtual ~RecordKinds() = default;
  /// Counted from 0; kUnknown: there is no such kind, and whoever sends it is wrong. Called by any thread, and for
  /// every record that a PE sends.
  virtual std::size_t record_kind(std::span<const std::byte> /*record*/) const { return 0; }
};

}  // namespace torolux
