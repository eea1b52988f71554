// SPDX-License-Identifier: MIT
// Whom `--follow` follows: a sample of a pixel, or a direction of a shot's point.
#pragma once

#include <cstdint>
#include <variant>

namespace torolux {

struct FollowedPixel {
  std::uint32_t column, row;  ///< row 0 on top
  std::uint32_t sample = 0;   ///< counted from 0
};

struct FollowedShot {
  std::uint32_t shot;           ///< counted from 0 over the radiosity stage, as the host does
  std::uint32_t point;          ///< counted from 0
  std::uint32_t direction = 0;  ///< pixel of the hemi-cube, counted from 0
};

using FollowTarget = std::variant<FollowedPixel, FollowedShot>;

}  // namespace torolux
