// SPDX-License-Identifier: MIT
// Differences between two looks at the machine become bytes; runs of the frame buffer that have changed, floats.
#include "host_tools/display/display_feed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace torolux {
namespace {

static_assert(FrameChanges::kRunPixels == LivePicture::kRunPixels);

constexpr std::uint8_t kNoPhase = 255;

std::uint64_t difference(std::uint64_t after, std::uint64_t before) {
  return after > before ? after - before : 0;
}

/// 0..the greatest Number.
template <class Number>
Number share(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return 0;
  const double value = static_cast<double>(std::min(part, whole)) / static_cast<double>(whole);
  return static_cast<Number>(std::lround(value * double{std::numeric_limits<Number>::max()}));
}

/// Of the two numbers, one may have been written without the other yet.
std::uint64_t busy_cycles(const LivePe& pe) {
  return difference(pe.clock, pe.waited);
}

/// A PE that waits tells nothing: up to the network's time it has done so.
std::uint64_t end_of(const LivePe& pe, const LiveFigures& figures) {
  return std::max(pe.clock, figures.now);
}

/// The phase that had most of its time since; `last` where no phase has been left since.
std::uint8_t phase_of(const LivePe& now, const LivePe& before, std::uint8_t last) {
  std::uint64_t most = 0;
  std::uint8_t phase = last;
  for (std::size_t i = 0; i < now.phase_cycles.size(); ++i) {
    const std::uint64_t cycles = difference(now.phase_cycles[i], before.phase_cycles[i]);
    if (cycles > most) {
      most = cycles;
      phase = static_cast<std::uint8_t>(i);
    }
  }
  return phase;
}

LivePicture::Pixel pixel_of(const PixelSums& sums, double unit) {
  return {static_cast<float>(static_cast<double>(sums[0]) * unit),
          static_cast<float>(static_cast<double>(sums[1]) * unit),
          static_cast<float>(static_cast<double>(sums[2]) * unit)};
}

}  // namespace

void DisplayFeed::describe(const nlohmann::json& machine) {
  put(MessageType::machine, machine.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void DisplayFeed::put(MessageType type, std::string contents) {
  state_.update().put(type, std::move(contents));
}

void DisplayFeed::begin_picture(std::uint32_t width, std::uint32_t height, std::string_view kind) {
  if (std::uint64_t{width} * height > LivePicture::kMostPixels) width = height = 0;
  const nlohmann::json description = {{"width", width}, {"height", height}, {"kind", kind}};
  picture_.assign(std::size_t{width} * height, {});
  seen_ = 0;
  state_.update().begin_picture(width, height, description.dump());
}

void DisplayFeed::begin_machine() {
  before_ = {};
  seen_ = 0;
}

void DisplayFeed::update(const Machine& machine, double radiance_per_quantum, std::string progress) {
  const Clock::time_point begin = Clock::now();
  machine.sample(now_);
  if (now_.now < before_.now || now_.pixels_added < seen_) begin_machine();
  before_.pes.resize(now_.pes.size());
  phases_.resize(now_.pes.size(), kNoPhase);
  if (auto update = state_.try_update()) {
    update->put(MessageType::progress, std::move(progress));
    put_loads(*update);
    put_changes(*update, machine, radiance_per_quantum);
    std::swap(now_, before_);
  }
  const Clock::time_point end = Clock::now();
  const auto rest = std::chrono::duration_cast<Clock::duration>((end - begin) * (1 / kMostShare - 1));
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kUpdateSeconds));
  // A little early is in time: the machine's own calls come about as often.
  next_ = std::max(begin + period * 9 / 10, end + rest);
}

void DisplayFeed::put_loads(LiveState::Update& update) {
  const std::size_t pes = now_.pes.size();
  std::string contents;
  contents.reserve(sizeof(LoadsHeader) + (2 + 2 * kLinks) * pes);
  append_bytes(contents, LoadsHeader{now_.now, now_.pixels_added, static_cast<std::uint32_t>(now_.torus_packets),
                                     static_cast<std::uint32_t>(pes)});
  std::string phases;
  std::array<std::string, kLinks> links;
  const std::uint64_t time = difference(now_.now, before_.now);
  for (std::size_t pe = 0; pe < pes; ++pe) {
    const LivePe& now = now_.pes[pe];
    const LivePe& before = before_.pes[pe];
    const std::uint64_t busy = difference(busy_cycles(now), busy_cycles(before));
    const auto load = share<std::uint8_t>(busy, difference(end_of(now, now_), end_of(before, before_)));
    phases_[pe] = phase_of(now, before, phases_[pe]);
    contents += static_cast<char>(load);
    phases += static_cast<char>(busy > 0 ? phases_[pe] : kNoPhase);
    for (std::size_t i = 0; i < kLinks; ++i)
      append_bytes(links[i], share<std::uint16_t>(difference(now.link_flits[i], before.link_flits[i]), time));
  }
  contents += phases;
  for (const std::string& direction : links) contents += direction;
  update.put(MessageType::loads, std::move(contents));
}

void DisplayFeed::rest() {
  std::string contents;
  append_bytes(contents, LoadsHeader{before_.now, before_.pixels_added, 0, static_cast<std::uint32_t>(phases_.size())});
  contents.append(phases_.size(), '\0');
  contents.append(phases_.size(), static_cast<char>(kNoPhase));
  contents.append(2 * kLinks * phases_.size(), '\0');
  put(MessageType::loads, std::move(contents));
}

void DisplayFeed::put_changes(LiveState::Update& update, const Machine& machine, double radiance_per_quantum) {
  const FrameChanges& changes = machine.frame_changes();
  if (changes.added() == seen_) return;
  const std::vector<PixelSums>& sums = machine.frame_buffer().plane(protocol::Plane::colour);
  const auto last = changes.last();
  for (std::size_t run = 0; run < last.size(); ++run) {
    if (last[run] <= seen_) continue;
    const std::size_t first = run * LivePicture::kRunPixels;
    const std::size_t end = std::min(first + LivePicture::kRunPixels, std::min(sums.size(), picture_.size()));
    row_.clear();
    for (std::size_t i = first; i < end; ++i) row_.push_back(picture_[i] = pixel_of(sums[i], radiance_per_quantum));
    update.put_pixels(first, row_);
  }
  seen_ = changes.added();
}

void DisplayFeed::show(const Picture& picture) {
  if (picture.pixels.size() != picture_.size()) return;
  LiveState::Update update = state_.update();
  for (std::size_t first = 0; first < picture_.size(); first += LivePicture::kRunPixels) {
    const std::size_t count = std::min(LivePicture::kRunPixels, picture_.size() - first);
    const std::span<const LivePicture::Pixel> run(&picture.pixels[first], count);
    if (std::equal(run.begin(), run.end(), picture_.begin() + static_cast<std::ptrdiff_t>(first))) continue;
    std::copy(run.begin(), run.end(), picture_.begin() + static_cast<std::ptrdiff_t>(first));
    update.put_pixels(first, run);
  }
}

}  // namespace torolux
