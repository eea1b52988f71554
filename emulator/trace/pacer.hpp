// SPDX-License-Identifier: MIT
// Who holds a run back, so that a person can follow it. Enters: what would happen next; leaves: whether it may.
#pragma once

#include <cstdint>

#include "emulator/time/event_queue.hpp"

namespace torolux {

/// By what somebody steps through a run.
enum class Step : std::uint8_t {
  event,   ///< of the network, the bus, the host or a PE's NIU
  packet,  ///< delivered
  round    ///< begun by the host's program: of the radiosity stage
};

/// Changes nothing of a run but how long it takes. PEs run ahead as ever, as far as virtual time lets them.
class Pacer {
 public:
  virtual ~Pacer() = default;
  /// The next event is due at this virtual time. False: not yet; asked again some milliseconds later, and the run
  /// attends to its `progress` meanwhile. True: it happens now.
  virtual bool lets(Cycles next) = 0;
  /// Something has happened that is counted; events are counted by `lets`.
  virtual void passed(Step what) = 0;
};

}  // namespace torolux
