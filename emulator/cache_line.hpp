// SPDX-License-Identifier: MIT
// The host computer's cache lines.
#pragma once

#include <cstddef>

namespace torolux {

inline constexpr std::size_t kCacheLine = 64;  ///< bytes

}  // namespace torolux
