// SPDX-License-Identifier: MIT
// Progress enters, at most five lines a second leave, each written over the one before.
#include "host_tools/report/progress_line.hpp"

#include <algorithm>

#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

constexpr std::chrono::milliseconds kInterval{200};
constexpr double kLeastFraction = 0.01;  ///< below these no time left is foretold
constexpr double kLeastSeconds = 1;
constexpr std::size_t kWidth = 79;

}  // namespace

std::string_view name_of(RenderStage stage) {
  switch (stage) {
    case RenderStage::load:
      return "load";
    case RenderStage::radiosity:
      return "radiosity";
    case RenderStage::ray_tracing:
      return "ray tracing";
  }
  return "";
}

std::string progress_text(const RenderProgress& progress, double clock_hertz, double seconds_left) {
  const double fraction = std::clamp(progress.fraction, 0.0, 1.0);
  std::string text = left(std::string(name_of(progress.stage)), 11) + right(percent(fraction, 0), 6);
  if (progress.stage == RenderStage::radiosity) text += "  unshot " + percent(progress.unshot_fraction, 2);
  if (progress.credits_total > 0)
    text += "  home " + std::to_string(progress.credits_home) + "/" + std::to_string(progress.credits_total);
  text += "  virtual " + fixed(1e3 * static_cast<double>(progress.virtual_time) / clock_hertz, 1) + " ms";
  if (seconds_left >= 0) text += "  left " + duration(seconds_left);
  return text.substr(0, kWidth);
}

void ProgressLine::show(const RenderProgress& progress) {
  if (!shown_) return;
  const Clock::time_point now = Clock::now();
  if (!begun_ || progress.stage != stage_) {
    begun_ = true;
    stage_ = progress.stage;
    stage_begin_ = now;
  } else if (now - last_ < kInterval) {
    return;
  }
  last_ = now;
  const double spent = std::chrono::duration<double>(now - stage_begin_).count();
  const double fraction = std::min(progress.fraction, 1.0);
  const double seconds_left =
      fraction >= kLeastFraction && spent >= kLeastSeconds ? spent * (1 - fraction) / fraction : -1;
  out_ << "\r\x1b[K" << progress_text(progress, hertz_, seconds_left) << std::flush;
  visible_ = true;
}

void ProgressLine::wipe() {
  if (visible_) out_ << "\r\x1b[K" << std::flush;
  visible_ = false;
}

}  // namespace torolux
