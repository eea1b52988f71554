// SPDX-License-Identifier: MIT
// What a processor waits for inside HINTs.
#pragma once

#include <cstddef>
#include <cstdint>

namespace torolux {

/// Why a processor's clock moved on in a HINT.
enum class WaitReason : std::uint8_t {
  arrivals,     ///< it received
  torus_place,  ///< its outgoing queue was full
  bus_place,
  copy,  ///< by a copy engine: the one before the packet or message sent, or the message received
  count
};
inline constexpr std::size_t kWaitReasons = static_cast<std::size_t>(WaitReason::count);

}  // namespace torolux
