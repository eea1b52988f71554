// SPDX-License-Identifier: MIT
// What can go wrong on a link: a packet and its hop in, the cycles lost to retries and injected delay out.
#pragma once

#include <cstdint>

#include "emulator/machine/description.hpp"
#include "emulator/torus/block.hpp"

namespace torolux {

/// Decided by a hash of the packet's number and hop, so the same in every run.
class LinkFaults {
 public:
  LinkFaults(const MachineDescription::Torus& torus, std::uint32_t injected_delay);

  bool none() const { return error_threshold_ == 0 && injected_delay_ == 0; }
  /// Cycles from the grant until the copy that arrives whole begins.
  std::uint64_t cycles_lost(const Block& block);
  std::uint64_t retries() const { return retries_; }

 private:
  std::uint32_t error_threshold_;  // of 2^32
  std::uint32_t retry_cycles_;
  std::uint32_t injected_delay_;
  std::uint64_t retries_ = 0;
};

/// Whether a receiver notices that bit `bit` of the block's data has been flipped: compares CRC-32 sums.
bool crc_detects_flip(const Block& block, std::uint32_t bit);

}  // namespace torolux
