// SPDX-License-Identifier: MIT
// What waits in host memory for a PE: two queues, so that neither waits for the other.
#pragma once

#include <cstddef>
#include <cstdint>

namespace torolux {

enum class HostQueue : std::uint8_t {
  program,  ///< from the host's program, in its order
  resend    ///< diverted records on their way back
};
inline constexpr std::size_t kHostQueues = 2;

}  // namespace torolux
