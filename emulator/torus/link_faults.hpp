// SPDX-License-Identifier: MIT
// Errors of links: a packet and its hop in, how many copies of it arrive with a bad CRC out.
#pragma once

#include <cstdint>

#include "emulator/description/description.hpp"
#include "emulator/torus/block.hpp"

namespace torolux {

/// Decided by a hash of the packet's number and hop, so the same in every run.
class LinkFaults {
 public:
  explicit LinkFaults(const MachineDescription::Torus& torus);

  /// Copies that fail before the one that arrives whole. Throws MachineFailure if a CRC does not notice.
  std::uint32_t bad_copies(const Block& block) { return error_threshold_ == 0 ? 0 : count_bad_copies(block); }
  std::uint64_t retries() const { return retries_; }
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(retries_);
  }

 private:
  std::uint32_t count_bad_copies(const Block& block);

  std::uint32_t error_threshold_;  // of 2^32
  std::uint64_t retries_ = 0;
};

}  // namespace torolux
