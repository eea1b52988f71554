// SPDX-License-Identifier: MIT
// Gauges are integrated from change to change. At the end all sums are brought to slices of one width; gauges and load
// become means over each slice.
#include "emulator/machine/time_line.hpp"

#include <algorithm>

namespace torolux {

void TimeLine::note(HostGauge gauge, double value, Cycles now) {
  Gauge& g = gauges_[static_cast<std::size_t>(gauge)];
  g.integral.add_interval(g.since, now, g.value);
  g.value = value;
  g.since = now;
}

TimeLineFigures TimeLine::figures(Cycles end, const std::vector<Slices<std::uint64_t>>& busy) const {
  TimeLineFigures figures;
  if (end == 0) return figures;
  const std::uint32_t shift = slice_shift_for(end - 1);
  figures.width = Cycles{1} << shift;
  figures.slices.resize(((end - 1) >> shift) + 1);
  TimeLine line = *this;
  for (std::size_t g = 0; g < kHostGauges; ++g) line.note(static_cast<HostGauge>(g), 0, end);
  for (auto* slices : {&line.packets_, &line.bus_, &line.frame_buffer_, &line.host_}) slices->widen(shift);
  std::array<std::uint64_t, kSlices> sums{};
  for (Slices<std::uint64_t> one : busy) {
    one.widen(shift);
    for (std::size_t i = 0; i < kSlices; ++i) sums[i] += one.sums()[i];
  }
  for (Gauge& gauge : line.gauges_) gauge.integral.widen(shift);
  for (std::size_t i = 0; i < figures.slices.size(); ++i) {
    TimeSlice& slice = figures.slices[i];
    const auto cycles = static_cast<double>(std::min(figures.width, end - i * figures.width));
    slice.load = static_cast<double>(sums[i]) / (cycles * static_cast<double>(busy.size()));
    slice.packets = line.packets_.sums()[i];
    slice.bus_cycles = line.bus_.sums()[i];
    slice.frame_buffer_cycles = line.frame_buffer_.sums()[i];
    slice.host_cycles = line.host_.sums()[i];
    for (std::size_t g = 0; g < kHostGauges; ++g) slice.gauges[g] = line.gauges_[g].integral.sums()[i] / cycles;
  }
  return figures;
}

}  // namespace torolux
