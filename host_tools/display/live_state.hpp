// SPDX-License-Identifier: MIT
// The newest of each kind of message: the run's thread puts it in, and each page's thread takes out what it has not
// yet sent. What is replaced before a page has taken it, that page misses: nobody waits for a slow one.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "host_tools/display/live_picture.hpp"
#include "host_tools/display/messages.hpp"

namespace torolux {

/// What a page has been sent.
struct Seen {
  std::uint64_t version = 0;
  PictureSeen picture;
  bool all_of_picture = true;
};

class LiveState {
 public:
  /// Changes that pages see together. While it lives, no page is served: make it short.
  class Update {
   public:
    Update(LiveState& state, std::unique_lock<std::mutex> lock);
    Update(Update&&) = default;
    Update& operator=(Update&&) = delete;
    ~Update();

    /// Replaces what there was of this type. Not `picture` or `pixels`.
    void put(MessageType type, std::string contents);
    /// As LivePicture::begin and put.
    void begin_picture(std::uint32_t width, std::uint32_t height, std::string description);
    void put_pixels(std::size_t first, std::span<const LivePicture::Pixel> pixels);

   private:
    LiveState& state_;
    std::unique_lock<std::mutex> lock_;
  };

  /// Waits for pages that are copying, some 0.1 ms.
  Update update() { return {*this, std::unique_lock(mutex_)}; }
  /// Waits for nobody; nothing where a page is copying.
  std::optional<Update> try_update();

  /// Waits up to `patience` for something that `seen` has not, and appends it to `out`, as messages.
  void take_news(Seen& seen, std::string& out, std::chrono::milliseconds patience);
  /// Wakes all who wait in take_news.
  void wake();

 private:
  struct Slot {
    std::uint64_t version = 0;
    std::string contents;
  };

  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t version_ = 0;
  std::array<Slot, static_cast<std::size_t>(MessageType::count)> slots_;
  LivePicture picture_;
};

}  // namespace torolux
