// SPDX-License-Identifier: MIT
// Samples where pixels need them: the frame buffer's sums after a pass enter, what the next pass takes leaves. By sums
// alone, which are integers, so that it is the same on every machine (docs/decisions/adaptive_samples.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "emulator/host/host_program.hpp"
#include "firmware/protocol/messages.hpp"
#include "host_tools/stages/ray_phase.hpp"

namespace torolux {

/// Edge of the blocks that get samples together [pixels]. The two halves of one pixel's samples agree by chance now and
/// then, and such a pixel would stay wrong.
inline constexpr std::uint32_t kBlockEdge = 2;

/// Of each pixel, row 0 on top; empty: all have all.
using SampleCounts = std::vector<std::uint32_t>;

class SamplePlan {
 public:
  /// settings.least_samples: 2..settings.samples.
  explicit SamplePlan(const RayTracingSettings& settings);

  /// Of the present pass, whose samples come in the order of their numbers.
  const SamplePass& pass() const { return pass_; }
  /// Longest tile: for that many PEs. All blocks of the present pass.
  std::vector<protocol::Tile> tiles(unsigned pes) const;
  bool finished() const { return finished_; }

  /// Sums of pixels of the present pass, from `first` on in a row.
  void take(std::uint32_t first, std::span<const PixelSums> sums);
  /// All have been taken. Returns the blocks that were looked at.
  std::uint64_t advance();

  template <class Archive>
  void archive(Archive& archive) {
    archive(pass_.first, pass_.count, chosen_, before_, sums_, exposure_, finished_);
  }

 private:
  std::uint32_t samples_after() const { return pass_.first + pass_.count; }
  double lightness(const PixelSums& sums, std::size_t block, std::uint32_t samples) const;
  void set_exposure();
  void choose();
  std::uint32_t pixels_in(std::size_t block) const;

  RayTracingSettings settings_;
  std::uint32_t columns_, rows_;  ///< of blocks
  SamplePass pass_;
  std::vector<std::uint8_t> chosen_;  ///< by block: belongs to the present pass
  std::vector<PixelSums> before_;     ///< by block: when the pass began
  std::vector<PixelSums> sums_;       ///< by block: after it
  double exposure_ = 0;               ///< from the mean of a block to linear display values
  bool finished_ = false;
};

}  // namespace torolux
