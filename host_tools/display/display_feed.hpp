// SPDX-License-Identifier: MIT
// A running machine enters, as often as it can be looked at; what pages show of it leaves, into the state that the
// server hands out. On the run's thread, of which it takes a bounded share.
#pragma once

#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "emulator/machine/machine.hpp"
#include "host_tools/display/live_state.hpp"
#include "host_tools/picture/picture.hpp"

namespace torolux {

class DisplayFeed {
 public:
  /// Looks at the machine so often, while that takes less than kMostShare of the time.
  static constexpr double kUpdateSeconds = 1.0 / 30;
  static constexpr double kMostShare = 0.03;

  explicit DisplayFeed(LiveState& state) : state_(state) {}

  /// What runs, for all of the display's life (docs/display.md).
  void describe(const nlohmann::json& machine);
  /// From now on the picture is this frame buffer's. kind: "frame_buffer", ...
  void begin_picture(std::uint32_t width, std::uint32_t height, std::string_view kind);

  /// Whether it is time for `update`: making what goes into it takes time, too.
  bool due() const { return Clock::now() >= next_; }
  /// From within the machine's `progress`. radiance_per_quantum: of its frame buffer's sums.
  void update(const Machine& machine, double radiance_per_quantum, std::string progress);
  /// Another machine than in the last update.
  void begin_machine();
  /// The machine has come to its end: nothing is busy any more.
  void rest();
  void put(MessageType type, std::string contents);
  /// All of the picture, of the size begun; what is as it was is not sent again.
  void show(const Picture& picture);

 private:
  using Clock = std::chrono::steady_clock;

  void put_loads(LiveState::Update& update);
  void put_changes(LiveState::Update& update, const Machine& machine, double radiance_per_quantum);

  LiveState& state_;
  Clock::time_point next_{};
  LiveFigures now_, before_;
  std::vector<std::uint8_t> phases_;         // of each PE, as last seen
  std::uint64_t seen_ = 0;                   // pixels added that pages know of
  std::vector<LivePicture::Pixel> row_;      // for a run of pixels
  std::vector<LivePicture::Pixel> picture_;  // as shown last
};

}  // namespace torolux
