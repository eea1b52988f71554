// SPDX-License-Identifier: MIT
// Hops that a packet has made before their time, because nobody was in its way.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "emulator/time/event_queue.hpp"
#include "emulator/torus/block.hpp"

namespace torolux {

/// One behind the other, each as many cycles after the last as a hop takes.
struct Advance {
  static constexpr std::size_t kMostHops = 32;
  /// What it changed at a router, as it was.
  struct Hop {
    Cycles output_free_at, input_free_at;
    std::uint16_t router;
    std::uint8_t input, output;  ///< that the packet takes there
    std::uint8_t next_input;
    bool input_was_unused;  ///< no packet had ever been in it
  };

  BlockIndex block = kNoBlock;  ///< kNoBlock: there is none, or its hops have been taken back
  std::uint8_t count = 0;       ///< of hops
  Cycles first = 0;             ///< time of the first
  std::array<Hop, kMostHops> hops{};
};

/// By number. A number is in use until the event of its end has come, even if the hops have been taken back.
class Advances {
 public:
  Advance& operator[](std::size_t number) { return all_[number]; }
  std::size_t size() const { return all_.size(); }
  bool full() const { return free_.empty() && all_.size() == kMost; }
  /// Only if there is room.
  std::uint16_t take() {
    if (free_.empty()) {
      all_.emplace_back();
      return static_cast<std::uint16_t>(all_.size() - 1);
    }
    const std::uint16_t number = free_.back();
    free_.pop_back();
    return number;
  }
  void give_back(std::uint16_t number) { free_.push_back(number); }
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(all_, free_);
  }

 private:
  static constexpr std::size_t kMost = 1U << 16U;

  std::vector<Advance> all_;
  std::vector<std::uint16_t> free_;
};

}  // namespace torolux
