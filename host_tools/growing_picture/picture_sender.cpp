// SPDX-License-Identifier: MIT
// Compares tiles with what the viewer has, and sends those that differ.
#include "host_tools/growing_picture/picture_sender.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace torolux {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kUpdate{250}, kSlice{10};
constexpr std::uint32_t kTile = 128;  // pixels to an edge
/// After the end of the run, a viewer that has taken nothing for so long is given up.
constexpr std::chrono::seconds kPatience{2};

/// Bit by bit: what is no number equals itself.
bool same(const Rectangle& tile, const std::vector<float>& a, const std::vector<float>& b, std::uint32_t width) {
  for (std::uint32_t row = tile.y; row < tile.y + tile.height; ++row) {
    const std::size_t at = std::size_t{row} * width + tile.x;
    if (std::memcmp(&a[at], &b[at], tile.width * sizeof(float)) != 0) return false;
  }
  return true;
}

void copy(const Rectangle& tile, const std::vector<float>& from, std::vector<float>& to, std::uint32_t width) {
  for (std::uint32_t row = tile.y; row < tile.y + tile.height; ++row) {
    const auto at = static_cast<std::ptrdiff_t>(std::size_t{row} * width + tile.x);
    std::copy_n(from.begin() + at, tile.width, to.begin() + at);
  }
}

}  // namespace

PictureSender::PictureSender(const ViewerAddress& where, std::string name, std::shared_ptr<const PictureState> begin)
    : connection_(where), name_(std::move(name)), width_(begin->picture.width), height_(begin->picture.height) {
  states_.put(std::move(begin));
  thread_ = std::thread([this] { work(); });
}

PictureSender::~PictureSender() {
  states_.close();
  if (thread_.joinable()) thread_.join();
}

bool PictureSender::finish(std::shared_ptr<const PictureState> state) {
  states_.put(std::move(state));
  states_.close();
  if (thread_.joinable()) thread_.join();
  return complete_;
}

void PictureSender::work() {
  for (bool last = false; !last;) {
    const Clock::time_point begin = Clock::now();
    last = states_.closed();
    if (const auto state = states_.take(kUpdate); state != nullptr) planes_ = planes_of(*state);
    complete_ = update();
    // What comes sooner is sent together.
    while (!states_.closed() && Clock::now() - begin < kUpdate) std::this_thread::sleep_for(kSlice);
  }
  connection_.look();  // what is unread when a connection is closed takes what was sent with it
  connection_.close();
}

bool PictureSender::update() {
  taken_at_ = Clock::now();
  connection_.look();
  if (!connection_.open()) {
    shown_.clear();
    if (!connection_.connect([this] { return states_.closed(); }) || !create()) return false;
  }
  for (std::uint32_t y = 0; y < height_; y += kTile) {
    for (std::uint32_t x = 0; x < width_; x += kTile) {
      if (!send_tile({x, y, std::min(kTile, width_ - x), std::min(kTile, height_ - y)})) return false;
    }
  }
  return true;
}

bool PictureSender::create() {
  std::vector<std::string> channels;
  channels.reserve(planes_.size());
  for (const NamedPlane& plane : planes_) channels.push_back(plane.channel);
  if (!send(create_image_message(name_, width_, height_, channels))) return false;
  // Viewers show a new picture as black.
  shown_.assign(planes_.size(), std::vector<float>(std::size_t{width_} * height_, 0.0F));
  return true;
}

bool PictureSender::send_tile(const Rectangle& tile) {
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    if (same(tile, planes_[i].values, shown_[i], width_)) continue;
    if (!send(update_image_message(name_, planes_[i].channel, tile, planes_[i].values, width_))) return false;
    copy(tile, planes_[i].values, shown_[i], width_);
  }
  return true;
}

bool PictureSender::stalled() {
  return states_.closed() && Clock::now() - taken_at_ > kPatience;
}

bool PictureSender::send(const std::vector<std::byte>& message) {
  if (!connection_.send(message, [this] { return stalled(); })) {
    shown_.clear();
    return false;
  }
  taken_at_ = Clock::now();
  return true;
}

}  // namespace torolux
