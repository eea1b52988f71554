// SPDX-License-Identifier: MIT
// The display of one run: progress and machines enter on the run's thread; pages in browsers show them. What pages ask
// for leaves as commands.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "host_tools/display/commands.hpp"
#include "host_tools/display/display_feed.hpp"
#include "host_tools/display/display_server.hpp"
#include "host_tools/display/pace.hpp"
#include "host_tools/display/radiosity_view.hpp"
#include "host_tools/render/render.hpp"
#include "host_tools/run/run.hpp"

namespace torolux {

/// What a page says of the run before anything of it is seen.
struct DisplayedRun {
  std::string what;   ///< "render" or "run"
  std::string title;  ///< of the scene or image
  unsigned columns = 0, rows = 0;
  double clock_hertz = 0;
  std::uint32_t width = 0, height = 0;  ///< of the picture; 0: there is none
  ToneMapping tone;
  PhaseNames phases = built_in_phase_names();  ///< of the image
};

class Display {
 public:
  /// Serves from now on. Throws InputError.
  Display(const DisplayAddress& where, const DisplayedRun& run);
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
  /// Pages are told.
  ~Display();

  const std::string& url() const { return server_.url(); }
  DisplayFeed& feed() { return feed_; }
  CommandQueue& commands() { return commands_; }
  Pace& pace() { return pace_; }

  /// From within a render's `progress`. False: a page has asked to end.
  bool show(const RenderProgress& progress);
  /// From within a machine's.
  bool show(const Machine& machine, Cycles now);
  /// What a PE has said.
  void say(const PeText& text);
  /// The run is over, its results are written. picture: null where there is none.
  void finish(const Picture* picture);
  void fail(const std::string& why);
  /// A command that is nobody else's.
  void obey(const DisplayCommand& command);
  bool ended() const { return ended_; }  ///< as a page has asked
  /// Progress of what comes after the run.
  void tell(nlohmann::json progress) { put_progress(std::move(progress)); }
  void put_camera(const nlohmann::json& camera);
  /// Serves on until a page asks to end, or `stop` says so (asked some times a second).
  void wait(const std::function<bool()>& stop);

 private:
  using Clock = std::chrono::steady_clock;

  void put_progress(nlohmann::json progress);
  void begin_frame_buffer();
  void show_radiosity(const RunningRender& running, RenderStage stage);
  bool obey();
  void put_packets();
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  Clock::time_point begin_ = Clock::now();
  LiveState state_;
  CommandQueue commands_;
  Pace pace_;
  bool free_told_ = true;  // that the run goes as fast as it can
  DisplayFeed feed_{state_};
  std::deque<std::string> texts_;
  std::optional<Clock::time_point> machine_begin_;
  unsigned machine_ = 0;                    // RunningRender::number
  std::uint32_t width_, height_;            // of the frame buffer
  std::optional<RadiosityView> radiosity_;  // in place of that, until the ray tracing stage begins
  bool shows_radiosity_ = false;
  Clock::time_point next_view_{};
  nlohmann::json progress_;  // as last told
  bool ended_ = false;       // as a page has asked
  DisplayServer server_;     // last: its threads end first
};

}  // namespace torolux
