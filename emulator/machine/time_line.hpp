// SPDX-License-Identifier: MIT
// A run over virtual time: what the network's side sees enters as it happens, slices of equal width leave.
#pragma once

#include <array>
#include <vector>

#include "emulator/host/host_program.hpp"
#include "emulator/time/slices.hpp"

namespace torolux {

struct TimeSlice {
  double load = 0;            ///< mean over the PEs: busy cycles of the slice
  std::uint64_t packets = 0;  ///< delivered by the torus
  Cycles bus_cycles = 0;      ///< busy, like the two that follow
  Cycles frame_buffer_cycles = 0;
  Cycles host_cycles = 0;
  std::array<double, kHostGauges> gauges{};  ///< by HostGauge, mean over the slice
};

struct TimeLineFigures {
  Cycles width = 0;  ///< of a slice; the last one may be cut short by the end of the run
  std::vector<TimeSlice> slices;
};

class TimeLine {
 public:
  void delivered(Cycles now) { packets_.add(now, 1); }
  void bus_was_busy(Cycles begin, Cycles end) { bus_.add_interval(begin, end, 1); }
  void frame_buffer_was_busy(Cycles begin, Cycles end) { frame_buffer_.add_interval(begin, end, 1); }
  void host_was_busy(Cycles begin, Cycles end) { host_.add_interval(begin, end, 1); }
  void note(HostGauge gauge, double value, Cycles now);

  /// busy: of each PE.
  TimeLineFigures figures(Cycles end, const std::vector<Slices<std::uint64_t>>& busy) const;
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(packets_, bus_, frame_buffer_, host_, gauges_);
  }

 private:
  struct Gauge {
    double value = 0;
    Cycles since = 0;
    Slices<double> integral{};
  };
  Slices<std::uint64_t> packets_{}, bus_{}, frame_buffer_{}, host_{};
  std::array<Gauge, kHostGauges> gauges_;
};

}  // namespace torolux
