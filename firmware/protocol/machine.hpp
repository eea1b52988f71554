// SPDX-License-Identifier: MIT
// The machine's fixed numbers: what every image, every engine and the host must agree on.
#pragma once

#include <cstddef>
#include <cstdint>

namespace torolux::protocol {

/// Raised whenever a struct or a rule in this folder changes. The NIU window carries it; both sides check.
inline constexpr std::uint32_t kProtocolVersion = 23;

/// First byte of a PE's local memory, and the address at which every image starts (`_start`).
inline constexpr std::uint32_t kLocalMemoryBase = 0x8000'0000U;
inline constexpr std::uint32_t kSmallestLocalMemory = 256U * 1024U;
inline constexpr std::uint32_t kDefaultLocalMemory = 1024U * 1024U;
inline constexpr std::uint32_t kLargestLocalMemory = 64U * 1024U * 1024U;
/// Regions with different rights (code, data) start on pages of this size [bytes].
inline constexpr std::uint32_t kPageBytes = 4096U;

/// PEs are numbered row by row: number = y * columns + x. The next values name the other actors.
using PeNumber = std::uint16_t;
inline constexpr PeNumber kMostPes = 0xFFF0U;
inline constexpr PeNumber kHost = 0xFFF1U;
inline constexpr PeNumber kFrameBuffer = 0xFFF2U;
inline constexpr PeNumber kNobody = 0xFFFFU;

/// The most records that one packet carries, and the most bytes of records that it may hold.
inline constexpr std::uint32_t kMostRecordsPerPacket = 16;
inline constexpr std::uint32_t kMostPacketBytes = 1024;
/// The most bytes of a bus message after its header.
inline constexpr std::uint32_t kMostMessageBytes = 1024;

}  // namespace torolux::protocol
