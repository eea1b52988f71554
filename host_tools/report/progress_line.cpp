// SPDX-License-Identifier: MIT
// Progress enters, at most five lines a second leave, each written over the one before.
#include "host_tools/report/progress_line.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

constexpr std::chrono::milliseconds kInterval{200};
constexpr double kLeastFraction = 0.01;  ///< below these no time left is foretold
constexpr double kLeastSeconds = 1;
constexpr std::size_t kUsualColumns = 80;

/// Of the terminal on standard error; it may be made wider or narrower at any time.
std::size_t columns_of_terminal() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualColumns;
}

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

double estimated_seconds_left(double spent, double overall) {
  const double done = std::min(overall, 1.0);
  return done >= kLeastFraction && spent >= kLeastSeconds ? spent * (1 - done) / done : -1;
}

std::string progress_text(const RenderProgress& progress, double clock_hertz, double seconds_left, std::size_t width,
                          bool verbose) {
  std::vector<std::string> parts = {right(percent(std::clamp(progress.overall, 0.0, 1.0), 0), 5)};
  if (seconds_left >= 0) parts.push_back(duration(seconds_left) + " left");
  parts.push_back(std::string(name_of(progress.stage)) + " " + percent(std::clamp(progress.fraction, 0.0, 1.0), 0));
  if (progress.stage == RenderStage::radiosity) parts.push_back("unshot " + percent(progress.unshot_fraction, 2));
  parts.push_back("virtual " + fixed(1e3 * static_cast<double>(progress.virtual_time) / clock_hertz, 1) + " ms");
  if (verbose && progress.credits_total > 0) {
    parts.push_back("credits home " + std::to_string(progress.credits_home) + "/" +
                    std::to_string(progress.credits_total));
  }
  std::string text;
  for (const std::string& part : parts) {
    const std::string longer = text + (text.empty() ? "" : "  ") + part;
    if (longer.size() > width) break;
    text = longer;
  }
  return text;
}

void ProgressLine::show(const RenderProgress& progress) {
  if (!shown_) return;
  const Clock::time_point now = Clock::now();
  if (!begun_) {
    begun_ = true;
    begin_ = now;
  } else if (now - last_ < kInterval) {
    return;
  }
  last_ = now;
  const double left = estimated_seconds_left(std::chrono::duration<double>(now - begin_).count(), progress.overall);
  out_ << "\r\x1b[K" << progress_text(progress, hertz_, left, columns_of_terminal() - 1, verbose_) << std::flush;
  visible_ = true;
}

void ProgressLine::show(const std::string& text) {
  if (!shown_) return;
  out_ << "\r\x1b[K" << text << std::flush;
  visible_ = true;
}

void ProgressLine::wipe() {
  if (visible_) out_ << "\r\x1b[K" << std::flush;
  visible_ = false;
}

}  // namespace torolux
