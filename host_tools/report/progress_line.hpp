// SPDX-License-Identifier: MIT
// The line that a render shows on a terminal while it works.
#pragma once

#include <chrono>
#include <ostream>
#include <string>

#include "host_tools/render/render.hpp"

namespace torolux {

std::string_view name_of(RenderStage stage);

/// One line, at most 79 characters, without a line end. seconds_left: of the stage; negative: not known yet.
std::string progress_text(const RenderProgress& progress, double clock_hertz, double seconds_left);

/// Shows the newest progress in place, a few times a second, and wipes it at the end.
class ProgressLine {
 public:
  /// shown: false where there is no terminal, or with --quiet; then nothing is written.
  ProgressLine(std::ostream& out, bool shown, double clock_hertz) : out_(out), shown_(shown), hertz_(clock_hertz) {}
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { wipe(); }

  void show(const RenderProgress& progress);
  void wipe();

 private:
  using Clock = std::chrono::steady_clock;

  std::ostream& out_;
  bool shown_;
  double hertz_;
  bool visible_ = false;
  bool begun_ = false;
  RenderStage stage_ = RenderStage::load;
  Clock::time_point stage_begin_{};
  Clock::time_point last_{};
};

}  // namespace torolux
