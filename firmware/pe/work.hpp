// SPDX-License-Identifier: MIT
// Work that the host has dealt to a PE, to be made into records while it has credits in hand.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/niu/niu.hpp"
#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/records.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

struct Pe;

/// Points that wait to be expanded, in the order in which they came.
struct Points {
  std::array<protocol::PointRecord, protocol::kPointPlaces> place{};
  std::uint32_t first = 0;
  std::uint32_t waiting = 0;
};

/// Credits of records that may be made here: granted by the host, or of records that have died here.
struct Credits {
  std::uint32_t in_hand = 0;
  bool asked = false;  ///< for more
  /// Without work they go home at once. Else they wait for what the host deals next, so that they need not come again.
  bool homewards = true;
};

bool has_work(const Pe& pe);
/// It has work, and credits for it.
bool can_work(const Pe& pe);
/// Makes a few records, and follows each; then others get their turn.
void work(Pe& pe, Niu& niu);
/// Tells the host of work done, sends home the credits that are not needed here, and asks for those that are.
void report_work(Pe& pe, Niu& niu);

}  // namespace torolux::pe
