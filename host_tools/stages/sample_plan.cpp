// SPDX-License-Identifier: MIT
// Two passes give all pixels the least; each further one doubles what the chosen blocks have. A block is chosen where
// what the pass has brought and what was there before would look different, and so are its neighbours.
#include "host_tools/stages/sample_plan.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/picture/lightness.hpp"
#include "host_tools/picture/tone_map.hpp"

namespace torolux {
namespace {

/// Tiles that each PE has at least, where there are as many blocks.
constexpr std::size_t kTilesOfPe = 32;
constexpr std::uint32_t kMostBlocksOfTile = 16;

std::array<float, 3> mean_of(const PixelSums& sums, double samples) {
  std::array<float, 3> mean{};
  for (std::size_t c = 0; c < mean.size(); ++c) mean[c] = static_cast<float>(static_cast<double>(sums[c]) / samples);
  return mean;
}

PixelSums difference(const PixelSums& a, const PixelSums& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

}  // namespace

SamplePlan::SamplePlan(const RayTracingSettings& settings)
    : settings_(settings),
      columns_((settings.width + kBlockEdge - 1) / kBlockEdge),
      rows_((settings.height + kBlockEdge - 1) / kBlockEdge),
      pass_{0, settings.least_samples / 2, 1},
      chosen_(std::size_t{columns_} * rows_, 1),
      before_(chosen_.size()),
      sums_(chosen_.size()) {}

std::vector<protocol::Tile> SamplePlan::tiles(unsigned pes) const {
  const auto blocks = static_cast<std::size_t>(std::ranges::count(chosen_, 1));
  const auto longest =
      static_cast<std::uint32_t>(std::clamp<std::size_t>(blocks / (kTilesOfPe * pes), 1, kMostBlocksOfTile));
  std::vector<protocol::Tile> tiles;
  for (std::uint32_t row = 0; row < rows_; ++row) {
    for (std::uint32_t column = 0; column < columns_;) {
      std::uint32_t end = column;
      while (end < columns_ && end - column < longest && chosen_[std::size_t{row} * columns_ + end] != 0) ++end;
      if (end == column) {
        ++column;
        continue;
      }
      const std::uint32_t x = column * kBlockEdge, y = row * kBlockEdge;
      tiles.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                       static_cast<std::uint16_t>(std::min(end * kBlockEdge, settings_.width) - x),
                       static_cast<std::uint16_t>(std::min(y + kBlockEdge, settings_.height) - y)});
      column = end;
    }
  }
  return tiles;
}

void SamplePlan::take(std::uint32_t first, std::span<const PixelSums> sums) {
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const std::size_t pixel = first + i;
    const std::size_t row = pixel / settings_.width / kBlockEdge, column = pixel % settings_.width / kBlockEdge;
    PixelSums& block = sums_[row * columns_ + column];
    for (std::size_t c = 0; c < block.size(); ++c) block[c] += sums[i][c];
  }
}

std::uint64_t SamplePlan::advance() {
  const auto looked_at = static_cast<std::uint64_t>(std::ranges::count(chosen_, 1));
  const std::uint32_t taken = samples_after();
  if (taken >= settings_.samples) {
    finished_ = true;
    return looked_at;
  }
  if (taken >= settings_.least_samples) {
    if (exposure_ == 0) set_exposure();
    choose();
    finished_ = std::ranges::none_of(chosen_, [](std::uint8_t chosen) { return chosen != 0; });
    pass_ = {taken, std::min(taken, settings_.samples - taken), 1};
  } else {
    pass_ = {taken, settings_.least_samples - taken, 1};
  }
  before_ = std::move(sums_);
  sums_.assign(before_.size(), PixelSums{});
  return looked_at;
}

std::uint32_t SamplePlan::pixels_in(std::size_t block) const {
  const auto column = static_cast<std::uint32_t>(block % columns_), row = static_cast<std::uint32_t>(block / columns_);
  return std::min(kBlockEdge, settings_.width - column * kBlockEdge) *
         std::min(kBlockEdge, settings_.height - row * kBlockEdge);
}

/// By the rule of a .png's at 0 EV: from the mean of a block's samples, in units of the sums.
void SamplePlan::set_exposure() {
  Picture means{columns_, rows_, {}};
  for (std::size_t block = 0; block < sums_.size(); ++block)
    means.pixels.push_back(mean_of(sums_[block], double{1} * pixels_in(block) * settings_.least_samples));
  exposure_ = exposure_factor(means, 0);
}

/// As a display would show it, L* 0..100.
double SamplePlan::lightness(const PixelSums& sums, std::size_t block, std::uint32_t samples) const {
  const std::array<float, 3> seen =
      compress(mean_of(sums, double{1} * pixels_in(block) * samples / exposure_), ToneCurve::filmic);
  return lab_of_xyz(relative_xyz({seen[0], seen[1], seen[2]}))[0];
}

void SamplePlan::choose() {
  const std::vector<std::uint8_t> was = chosen_;
  std::ranges::fill(chosen_, 0);
  for (std::uint32_t row = 0; row < rows_; ++row) {
    for (std::uint32_t column = 0; column < columns_; ++column) {
      const std::size_t block = std::size_t{row} * columns_ + column;
      if (was[block] == 0) continue;
      const double first = lightness(before_[block], block, pass_.first);
      const double second = lightness(difference(sums_[block], before_[block]), block, pass_.count);
      if (!(std::abs(first - second) > settings_.noise)) continue;
      for (std::uint32_t y = std::max(row, 1U) - 1; y < std::min(row + 2, rows_); ++y) {
        for (std::uint32_t x = std::max(column, 1U) - 1; x < std::min(column + 2, columns_); ++x)
          chosen_[std::size_t{y} * columns_ + x] = was[std::size_t{y} * columns_ + x];
      }
    }
  }
}

}  // namespace torolux
