// SPDX-License-Identifier: MIT
// The end of an arrival: out of its ring, and its payload back to where payloads are.
#pragma once

#include "emulator/niu/channel.hpp"

namespace torolux {

/// Of the arrival that `front` gave, once its contents have been read. Others may still hold a payload that is shared.
inline void pop_arrival(NiuChannel& channel, const Arrival& arrival) {
  if (arrival.shared) {
    channel.payloads->let_go(arrival.payload);
  } else if (arrival.payload != nullptr) {
    channel.payloads->give_back(arrival.payload);
  }
  channel.arrivals.pop(arrival);
}

}  // namespace torolux
