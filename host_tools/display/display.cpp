// SPDX-License-Identifier: MIT
// Progress as JSON; commands that are the display's own are obeyed.
#include "host_tools/display/display.hpp"

#include <algorithm>
#include <utility>

#include "emulator/errors.hpp"
#include "emulator/printable.hpp"
#include "firmware/protocol/hints.hpp"
#include "host_tools/colour/white_point.hpp"
#include "host_tools/render/running_render.hpp"
#include "host_tools/report/progress_line.hpp"

namespace torolux {
namespace {

constexpr std::size_t kMostTexts = 200;
constexpr std::chrono::milliseconds kPatience{100};
/// Of the time, for the view of the radiosity stage; and from one to the next, at least.
constexpr double kViewShare = 0.01;
constexpr std::chrono::milliseconds kViewPeriod{250};

std::string text_of(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// By number, up to the last that has a name; null: it has none.
nlohmann::json phases_json(const PhaseNames& names) {
  nlohmann::json json = nlohmann::json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) continue;
    json.get_ref<nlohmann::json::array_t&>().resize(i);
    json.push_back(names[i]);
  }
  return json;
}

/// "off", "auto", or the change of colours, row by row.
nlohmann::json white_json(const WhiteBalance& white) {
  if (white.kind == WhiteBalance::Kind::kelvin) return adaptation_to(light_of(white.kelvin));
  return white.kind == WhiteBalance::Kind::automatic ? "auto" : "off";
}

nlohmann::json json_of(const DisplayedRun& run) {
  return {{"protocol", 1},
          {"what", run.what},
          {"title", run.title},
          {"columns", run.columns},
          {"rows", run.rows},
          {"clock_hertz", run.clock_hertz},
          {"phases", phases_json(run.phases)},
          {"exposure_ev", run.tone.exposure_ev},
          {"tone_curve", run.tone.curve == ToneCurve::filmic ? "filmic" : "linear"},
          {"white_balance", white_json(run.tone.white)}};
}

}  // namespace

Display::Display(const DisplayAddress& where, const DisplayedRun& run)
    : width_(run.width), height_(run.height), server_(where, state_, commands_) {
  feed_.describe(json_of(run));
  if (run.width > 0) feed_.begin_picture(run.width, run.height, "frame_buffer");
  put_progress({{"state", "preparing"}});
}

Display::~Display() {
  feed_.put(MessageType::bye, "{}");
}

void Display::put_progress(nlohmann::json progress) {
  progress["elapsed"] = elapsed();
  progress_ = std::move(progress);
  feed_.put(MessageType::progress, text_of(progress_));
}

/// Commands are taken out until there is none, or one is to end.
bool Display::obey() {
  while (!ended_) {
    const auto command = commands_.take();
    if (!command) return true;
    obey(*command);
  }
  return false;
}

void Display::obey(const DisplayCommand& command) {
  if (command.name == "end") {
    ended_ = true;
    pace_.go_free();
  }
  if (command.name == "ask") command.answer->give(R"({"error": "there are answers once a picture is rendered"})");
  if (command.name != "pace") return;
  try {
    pace_.obey(command.values);
  } catch (const InputError& error) {
    progress_["error"] = error.what();
  }
}

void Display::put_packets() {
  if (pace_.is_free() && free_told_) return;
  free_told_ = pace_.is_free();
  feed_.put(MessageType::packets, pace_.packets());
}

void Display::put_camera(const nlohmann::json& camera) {
  feed_.put(MessageType::camera, text_of(camera));
}

bool Display::show(const RenderProgress& progress) {
  if (!obey()) return false;
  if (!feed_.due() || progress.running == nullptr) return true;
  const RunningRender& running = *progress.running;
  if (machine_ != running.number) feed_.begin_machine();
  if (!machine_begin_) machine_begin_ = Clock::now();
  const double spent = std::chrono::duration<double>(Clock::now() - *machine_begin_).count();
  progress_ = {{"state", "running"},
               {"draft", running.draft},
               {"stage", name_of(progress.stage)},
               {"fraction", progress.fraction},
               {"overall", progress.overall},
               {"seconds_left", estimated_seconds_left(spent, progress.overall)},
               {"unshot", progress.unshot_fraction},
               {"credits_home", progress.credits_home},
               {"credits_total", progress.credits_total},
               {"virtual_time", progress.virtual_time},
               {"elapsed", elapsed()}};
  show_radiosity(running, progress.stage);
  feed_.update(running.machine, running.setup.radiance_per_quantum(), text_of(progress_));
  put_packets();
  return true;
}

void Display::begin_frame_buffer() {
  if (!shows_radiosity_) return;
  shows_radiosity_ = false;
  radiosity_.reset();
  feed_.begin_picture(width_, height_, "frame_buffer");
}

/// As long as there is nothing in the frame buffer.
void Display::show_radiosity(const RunningRender& running, RenderStage stage) {
  // Another machine has another mesh; what has been shown of the last one stays until there is something of this one.
  if (machine_ != running.number) radiosity_.reset();
  machine_ = running.number;
  if (stage == RenderStage::ray_tracing) begin_frame_buffer();
  if (stage != RenderStage::radiosity) return;
  if (!radiosity_) {
    radiosity_.emplace(running);
    shows_radiosity_ = true;
    feed_.begin_picture(radiosity_->width(), radiosity_->height(), "radiosity");
  }
  radiosity_->work(running, kViewShare * DisplayFeed::kUpdateSeconds);
  const Clock::time_point begin = Clock::now();
  if (begin < next_view_) return;
  feed_.show(radiosity_->picture(running));
  const Clock::time_point end = Clock::now();
  next_view_ =
      std::max(begin + kViewPeriod, end + std::chrono::duration_cast<Clock::duration>((end - begin) / kViewShare));
}

bool Display::show(const Machine& machine, Cycles now) {
  if (!obey()) return false;
  if (!feed_.due()) return true;
  progress_ = {{"state", "running"}, {"virtual_time", now}, {"elapsed", elapsed()}};
  feed_.update(machine, 1, text_of(progress_));
  put_packets();
  return true;
}

void Display::say(const PeText& text) {
  texts_.push_back("PE " + std::to_string(text.pe) + " @ " + std::to_string(text.time) + ": " + printable(text.text));
  if (texts_.size() > kMostTexts) texts_.pop_front();
  feed_.put(MessageType::texts, text_of(nlohmann::json(texts_)));
}

void Display::finish(const Picture* picture) {
  begin_frame_buffer();
  if (picture != nullptr) feed_.show(*picture);
  feed_.rest();
  nlohmann::json progress = progress_;
  progress["state"] = "done";
  progress["fraction"] = progress["overall"] = 1;
  put_progress(std::move(progress));
}

void Display::fail(const std::string& why) {
  nlohmann::json progress = progress_;
  progress["state"] = "failed";
  progress["error"] = why;
  put_progress(std::move(progress));
}

void Display::wait(const std::function<bool()>& stop) {
  while (!ended_ && !stop()) {
    if (const auto command = commands_.take(kPatience)) obey(*command);
  }
}

}  // namespace torolux
