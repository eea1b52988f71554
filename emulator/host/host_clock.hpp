// SPDX-License-Identifier: MIT
// The clock of the host's one processor. Enters: items of work; leaves: the time in cycles of the PEs, exactly.
#pragma once

#include <array>
#include <cstdint>

#include "emulator/description/description.hpp"
#include "emulator/description/host_work.hpp"
#include "emulator/time/event_queue.hpp"

namespace torolux {

/// Work takes cycles of the host; one of them is processor.clock_hertz / host.clock_hertz cycles of the PEs. What is
/// left over of a PE's cycle is kept while the host works on, and rounded up when others see it.
class HostClock {
 public:
  explicit HostClock(const MachineDescription& machine);

  /// Nothing to do until then, if that is later than the clock.
  void wait_until(Cycles time);
  /// Throws MachineFailure if the clock would leave what virtual time can hold.
  void work(HostWork what, std::uint64_t items);
  /// All work so far has ended by then.
  Cycles now() const { return cycles_ + (part_ != 0 ? 1 : 0); }

  /// Of the cycles up to `now`, those in which the host had work.
  Cycles busy(Cycles now) const { return now - idle_ - (now > this->now() ? now - this->now() : 0); }
  /// By HostWork, in the host's own cycles.
  const std::array<std::uint64_t, kHostWorks>& own_cycles() const { return own_cycles_; }
  const std::array<std::uint64_t, kHostWorks>& items() const { return items_; }
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(cycles_, part_, idle_, own_cycles_, items_);
  }

 private:
  std::array<std::uint64_t, kHostWorks> cost_;  // [host cycles] of an item
  std::uint64_t pe_hertz_, host_hertz_;
  Cycles cycles_ = 0;
  std::uint64_t part_ = 0;  // of the next cycle: part_ / host_hertz_
  Cycles idle_ = 0;
  std::array<std::uint64_t, kHostWorks> own_cycles_{};
  std::array<std::uint64_t, kHostWorks> items_{};
};

}  // namespace torolux
