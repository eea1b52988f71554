// SPDX-License-Identifier: MIT
// Slots with versions behind one lock.
#include "host_tools/display/live_state.hpp"

#include <utility>

namespace torolux {

LiveState::Update::Update(LiveState& state, std::unique_lock<std::mutex> lock) : state_(state), lock_(std::move(lock)) {
  ++state_.version_;
}

LiveState::Update::~Update() {
  if (!lock_.owns_lock()) return;  // moved from
  lock_.unlock();
  state_.changed_.notify_all();
}

void LiveState::Update::put(MessageType type, std::string contents) {
  state_.slots_[static_cast<std::size_t>(type)] = {state_.version_, std::move(contents)};
}

void LiveState::Update::begin_picture(std::uint32_t width, std::uint32_t height, std::string description) {
  state_.picture_.begin(width, height, std::move(description), state_.version_);
}

void LiveState::Update::put_pixels(std::size_t first, std::span<const LivePicture::Pixel> pixels) {
  state_.picture_.put(first, pixels, state_.version_);
}

std::optional<LiveState::Update> LiveState::try_update() {
  std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return std::nullopt;
  return std::optional<Update>(std::in_place, *this, std::move(lock));
}

void LiveState::take_news(Seen& seen, std::string& out, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return version_ != seen.version || !seen.all_of_picture; });
  if (version_ == seen.version && seen.all_of_picture) return;
  for (std::size_t type = 0; type < slots_.size(); ++type) {
    if (type == static_cast<std::size_t>(MessageType::pixels)) {
      seen.all_of_picture = picture_.append_news(seen.picture, out);
    } else if (slots_[type].version > seen.version) {
      append_message(out, static_cast<MessageType>(type), slots_[type].contents);
    }
  }
  seen.version = version_;
}

void LiveState::wake() {
  update();
}

}  // namespace torolux
