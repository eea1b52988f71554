// SPDX-License-Identifier: MIT
// A line along each ring and direction that says "someone starves": who begins and ceases to starve in, what all
// routers of the ring see, a fixed time later, out.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "emulator/time/event_queue.hpp"
#include "emulator/torus/shape.hpp"

namespace torolux {

/// A wired OR. Every router of a ring sees a change as many cycles later as a signal takes once around it, so all see
/// the same at the same time. Makes events only where something changes.
class RingLines {
 public:
  /// first_source: event source of router 0.
  RingLines(TorusShape shape, std::uint32_t link_cycles, EventQueue& events, std::uint32_t first_source)
      : shape_(shape),
        link_cycles_(link_cycles),
        events_(events),
        first_source_(first_source),
        lines_(std::size_t{2} * (shape.columns() + shape.rows())) {}

  /// Whether the line of the ring that this output belongs to is seen to be raised.
  bool seen(unsigned router, Port output) const { return raised_ != 0 && lines_[line(router, output)].seen; }
  /// Whether none is seen to be raised, or will be for what has happened so far.
  bool quiet() const { return raised_ == 0 && on_their_way_ == 0; }
  void begin(unsigned router, Port output, Cycles now) {
    if (lines_[line(router, output)].starving++ == 0) tell(router, output, true, now);
  }
  void end(unsigned router, Port output, Cycles now) {
    if (--lines_[line(router, output)].starving == 0) tell(router, output, false, now);
  }
  /// Kind line. Returns whether it is raised.
  bool handle(const Event& event) {
    --on_their_way_;
    lines_[line(event.actor, static_cast<Port>(event.port))].seen = event.block != 0;
    count_raised();
    return event.block != 0;
  }
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(lines_, on_their_way_);
    count_raised();
  }

 private:
  struct Line {
    std::uint32_t starving = 0;  // routers
    bool seen = false;
  };

  void count_raised() { raised_ = std::ranges::count(lines_, true, &Line::seen); }
  static bool along_x(Port output) { return output == Port::east || output == Port::west; }
  std::size_t line(unsigned router, Port output) const {
    const unsigned ring = along_x(output) ? router / shape_.columns() : shape_.rows() + router % shape_.columns();
    return std::size_t{2} * ring + (output == Port::west || output == Port::north ? 1U : 0U);
  }
  void tell(unsigned router, Port output, bool raised, Cycles now) {
    const unsigned first = along_x(output) ? router / shape_.columns() * shape_.columns() : router % shape_.columns();
    const Cycles around = Cycles{link_cycles_} * (along_x(output) ? shape_.columns() : shape_.rows());
    ++on_their_way_;
    // One source for each ring, so that changes of one cycle arrive in the order in which they were made.
    events_.push(now + around, first_source_ + first, EventKind::line, static_cast<std::uint16_t>(first),
                 static_cast<std::uint8_t>(output), raised ? 1 : 0);
  }

  TorusShape shape_;
  std::uint32_t link_cycles_;
  EventQueue& events_;
  std::uint32_t first_source_;
  std::vector<Line> lines_;
  std::uint64_t on_their_way_ = 0;  // changes that are not seen yet
  std::ptrdiff_t raised_ = 0;       // lines seen to be; mostly none, and which is whose need not be worked out
};

}  // namespace torolux
