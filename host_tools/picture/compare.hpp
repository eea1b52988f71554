// SPDX-License-Identifier: MIT
// Two pictures enter; by how much they differ leaves.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "host_tools/picture/picture.hpp"

namespace torolux {

struct Comparison {
  std::array<double, 3> mean{};            ///< of the picture, R G B [W/(m^2 sr)]
  std::array<double, 3> reference_mean{};  ///< of the reference
  /// sqrt(mean square of the difference / mean square of the reference), over pixels and channels. Infinite for a black
  /// reference and another picture.
  double relative_rmse = 0;
  /// The same over the means of blocks of 4 x 4 pixels (smaller at the right and lower edges), after both pictures have
  /// been clamped at `clamp`, so that visible emitters and single noisy pixels do not hide the rest.
  double block_rmse = 0;
  double clamp = 0;             ///< 97th percentile of all channel values of the reference
  double worst = 0;             ///< greatest difference of a channel [W/(m^2 sr)]
  std::uint32_t worst_x = 0;    ///< where it is
  std::uint32_t worst_y = 0;    ///< row, 0 on top
  unsigned worst_channel = 0;   ///< 0 R, 1 G, 2 B
  std::uint64_t differing = 0;  ///< pixels that are not equal bit for bit
};

/// Throws InputError where the sizes differ or a value is not a finite number.
Comparison compare(const Picture& picture, const Picture& reference);

/// |picture - reference|, channel by channel. Same size.
Picture difference(const Picture& picture, const Picture& reference);

}  // namespace torolux
