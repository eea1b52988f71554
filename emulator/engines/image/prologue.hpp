// SPDX-License-Identifier: MIT
// How a function without debug information has begun. Enters: its instructions up to some place; leaves: where its
// frame and its caller's registers are, as far as stores above a lowered stack pointer tell it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "emulator/engines/image/image.hpp"

namespace torolux {

struct FrameLayout {
  std::uint32_t bytes = 0;  ///< the stack pointer's distance from where it was as the function began
  /// Where x0..x31 are saved, from there: mostly below it, negative.
  std::array<std::optional<std::int32_t>, 32> saved;
};

/// begin: of the function; end: where it stands. Nothing: the stack pointer is set in a way that this does not follow.
std::optional<FrameLayout> frame_layout(const Image& image, std::uint32_t begin, std::uint32_t end);

}  // namespace torolux
