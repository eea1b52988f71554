// SPDX-License-Identifier: MIT
// A render's progress enters; the line that shows it on a terminal leaves.
#pragma once

#include <chrono>
#include <ostream>
#include <string>

#include "host_tools/render/render.hpp"

namespace torolux {

std::string_view name_of(RenderStage stage);

/// Of all stages, after so many: negative: not known yet. overall: done, 0..1.
double estimated_seconds_left(double spent, double overall);

/// One line of at most so many characters, without a line end: what matters most first, and what does not fit left out.
/// seconds_left: of all stages; negative: not known yet. verbose: credits at home, too.
std::string progress_text(const RenderProgress& progress, double clock_hertz, double seconds_left, std::size_t width,
                          bool verbose);

/// Shows the newest progress in place, a few times a second, and wipes it at the end.
class ProgressLine {
 public:
  /// shown: false where there is no terminal, or with --quiet; then nothing is written.
  ProgressLine(std::ostream& out, bool shown, double clock_hertz, bool verbose = false)
      : out_(out), shown_(shown), hertz_(clock_hertz), verbose_(verbose) {}
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { wipe(); }

  void show(const RenderProgress& progress);
  void show(const std::string& text);
  void wipe();

 private:
  using Clock = std::chrono::steady_clock;

  std::ostream& out_;
  bool shown_;
  double hertz_;
  bool verbose_;
  bool visible_ = false;
  bool begun_ = false;
  Clock::time_point begin_{};
  Clock::time_point last_{};
};

}  // namespace torolux
