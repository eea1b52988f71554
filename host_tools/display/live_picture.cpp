// SPDX-License-Identifier: MIT
// Runs of pixels with versions; neighbouring runs that are new travel in one message.
#include "host_tools/display/live_picture.hpp"

#include <algorithm>

#include "host_tools/display/messages.hpp"

namespace torolux {

void LivePicture::begin(std::uint32_t width, std::uint32_t height, std::string description, std::uint64_t version) {
  description_ = std::move(description);
  begun_ = version;
  pixels_.assign(std::size_t{width} * height, Pixel{});
  versions_.assign((pixels_.size() + kRunPixels - 1) / kRunPixels, 0);
}

void LivePicture::put(std::size_t first, std::span<const Pixel> pixels, std::uint64_t version) {
  if (first >= pixels_.size() || pixels.empty()) return;
  const std::size_t count = std::min(pixels.size(), pixels_.size() - first);
  std::copy_n(pixels.begin(), count, pixels_.begin() + static_cast<std::ptrdiff_t>(first));
  for (std::size_t run = first / kRunPixels; run <= (first + count - 1) / kRunPixels; ++run) versions_[run] = version;
}

bool LivePicture::append_news(PictureSeen& seen, std::string& out) const {
  if (begun_ == 0) return true;
  if (seen.begun != begun_) {
    seen.begun = begun_;
    seen.versions.assign(versions_.size(), 0);
    append_message(out, MessageType::picture, description_);
  }
  std::size_t left = kMostPixelsAtOnce;
  for (std::size_t run = 0; run < versions_.size(); ++run) {
    if (seen.versions[run] == versions_[run]) continue;
    if (left == 0) return false;
    const std::size_t first = run * kRunPixels;
    std::size_t count = 0;
    for (; run < versions_.size() && seen.versions[run] != versions_[run] && left > 0; ++run) {
      seen.versions[run] = versions_[run];
      const std::size_t pixels = std::min(kRunPixels, pixels_.size() - run * kRunPixels);
      count += pixels;
      left -= std::min(left, pixels);
    }
    --run;  // the loop's own step
    append_bytes(out, MessageHeader{static_cast<std::uint32_t>(MessageType::pixels),
                                    static_cast<std::uint32_t>(sizeof(PixelsHeader) + count * sizeof(Pixel))});
    append_bytes(out, PixelsHeader{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
    out.append(reinterpret_cast<const char*>(&pixels_[first]), count * sizeof(Pixel));
  }
  return true;
}

}  // namespace torolux
