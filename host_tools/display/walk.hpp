// SPDX-License-Identifier: MIT
// Walking through a solved scene: cameras that pages ask for enter; pictures leave, coarse at first, finer while nobody
// moves. The newest camera wins.
#pragma once

#include <deque>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "host_tools/display/display.hpp"
#include "host_tools/display/questions.hpp"
#include "host_tools/render/session.hpp"

namespace torolux {

/// Of a pixel's `samples`, in the order in which a walk takes them: one, one more, two more, four more, ...
std::vector<SamplePass> refining_passes(std::uint32_t samples);

/// {"eye": [x, y, z], "look_at": ..., "up": ..., "fov": degrees}; what is not there, and the lens, is as in
/// `like`. Throws InputError.
Camera camera_of(const nlohmann::json& values, const Camera& like);
nlohmann::json json_of(const Camera& camera);

class Walk {
 public:
  /// A pixel of the first, coarse picture stands for so many by so many.
  static constexpr std::uint32_t kCoarse = 4;

  /// session: its first run has ended, and stays. camera, quality: of that run. questions: of that session; answers
  /// come between commands, those that take the machine between views. All outlive this.
  Walk(RenderSession& session, Display& display, const Camera& camera, const Quality& quality, Questions& questions);

  /// On the run's thread, until a page asks to end or `stop` says so (asked some times a second).
  void go(const std::function<bool()>& stop);

 private:
  void take(const DisplayCommand& command);
  bool goes_on();
  void answer(const DisplayCommand& question);
  void make(const Camera& camera);
  bool pass(const View& view);
  void show(std::uint32_t taken, bool coarse);

  RenderSession& session_;
  Display& display_;
  Camera camera_;
  std::uint32_t width_, height_, samples_;
  Questions& questions_;
  std::deque<DisplayCommand> asked_;  // of the machine, and not yet answered
  std::optional<Camera> wanted_;      // the newest that nobody has begun with
  const std::function<bool()>* stop_ = nullptr;
};

}  // namespace torolux
