// SPDX-License-Identifier: MIT
// A view is a pass over a small picture, then passes over a large one. Between passes, and some ten times a second
// within one, newer commands are looked for.
#include "host_tools/display/walk.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "emulator/errors.hpp"
#include "host_tools/layout/golden_step.hpp"
#include "host_tools/scene/camera.hpp"
#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {
namespace {

constexpr std::chrono::milliseconds kPatience{50};

Vec3d vector_of(const nlohmann::json& values, const char* key, const Vec3d& like) {
  const auto at = values.find(key);
  if (at == values.end()) return like;
  if (!at->is_array() || at->size() != 3) throw InputError(std::string(key) + " is no array of three numbers");
  Vec3d vector{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const nlohmann::json& value = (*at)[axis];
    if (!value.is_number() || !(std::abs(value.get<double>()) <= kMostCoordinate)) {
      throw InputError(std::string(key) + " has a value that is no number, or too large");
    }
    vector[axis] = value.get<double>();
  }
  return vector;
}

/// Each pixel as a square of `times` by `times`, cut off at the right and at the bottom.
Picture enlarged(const Picture& small, std::uint32_t times, std::uint32_t width, std::uint32_t height) {
  Picture large{width, height, {}};
  large.pixels.reserve(std::size_t{width} * height);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      large.pixels.push_back(small.pixels[std::size_t{y / times} * small.width + x / times]);
    }
  }
  return large;
}

}  // namespace

std::vector<SamplePass> refining_passes(std::uint32_t samples) {
  const auto step = static_cast<std::uint32_t>(golden_step(samples));
  std::vector<SamplePass> passes;
  for (std::uint32_t taken = 0; taken < samples;) {
    const std::uint32_t count = std::min(std::max(1U, taken), samples - taken);
    passes.push_back({taken, count, step});
    taken += count;
  }
  return passes;
}

Camera camera_of(const nlohmann::json& values, const Camera& like) {
  Camera camera;
  camera.eye = vector_of(values, "eye", like.eye);
  camera.look_at = vector_of(values, "look_at", like.look_at);
  camera.up = vector_of(values, "up", like.up);
  camera.field_of_view_degrees = like.field_of_view_degrees;
  camera.aperture = like.aperture;
  camera.focus = like.focus;
  if (const auto fov = values.find("fov"); fov != values.end()) {
    if (!fov->is_number()) throw InputError("fov is no number");
    camera.field_of_view_degrees = fov->get<double>();
  }
  if (const auto wrong = camera_fault(camera)) throw InputError("the camera " + *wrong);
  return camera;
}

nlohmann::json json_of(const Camera& camera) {
  nlohmann::json json = {
      {"eye", camera.eye}, {"look_at", camera.look_at}, {"up", camera.up}, {"fov", camera.field_of_view_degrees}};
  if (camera.aperture > 0) {
    json["aperture"] = camera.aperture;
    json["focus"] = focus_distance(camera);
  }
  return json;
}

Walk::Walk(RenderSession& session, Display& display, const Camera& camera, const Quality& quality, Questions& questions)
    : session_(session),
      display_(display),
      camera_(camera),
      width_(quality.width),
      height_(quality.height),
      samples_(quality.samples),
      questions_(questions) {}

void Walk::answer(const DisplayCommand& question) {
  const auto answer = questions_.answer(question.values, camera_, [this] { return goes_on(); });
  question.answer->give(answer.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void Walk::take(const DisplayCommand& command) {
  if (command.name == "ask") {
    if (!Questions::asks_machine(command.values)) return answer(command);
    if (asked_.size() < CommandQueue::kMostWaiting) return asked_.push_back(command);
    return command.answer->give(R"({"error": "too many questions wait"})");
  }
  if (command.name != "view") return display_.obey(command);
  try {
    wanted_ = camera_of(command.values, camera_);
  } catch (const InputError& error) {
    display_.tell({{"state", "done"}, {"error", error.what()}});
  }
}

/// Takes what has come; true: nothing that ends the present view.
bool Walk::goes_on() {
  while (const auto command = display_.commands().take()) take(*command);
  return !wanted_ && !display_.ended() && !(*stop_)();
}

void Walk::go(const std::function<bool()>& stop) {
  stop_ = &stop;
  display_.put_camera(json_of(camera_));
  while (!display_.ended() && !stop()) {
    if (wanted_) {
      const Camera camera = *wanted_;
      wanted_.reset();
      make(camera);
    } else if (!asked_.empty()) {
      const DisplayCommand question = std::move(asked_.front());
      asked_.pop_front();
      answer(question);
    } else if (const auto command = display_.commands().take(kPatience)) {
      take(*command);
    }
  }
}

bool Walk::pass(const View& view) {
  return session_.view(view, [this] { return goes_on(); });
}

void Walk::show(std::uint32_t taken, bool coarse) {
  const Picture picture = session_.picture(taken);
  const Picture shown = coarse ? enlarged(picture, kCoarse, width_, height_) : picture;
  display_.feed().show(shown);
  questions_.take(shown);
  display_.tell({{"state", taken == samples_ && !coarse ? "done" : "walking"},
                 {"samples", coarse ? 0 : taken},
                 {"of_samples", samples_},
                 {"fraction", coarse ? 0 : static_cast<double>(taken) / samples_},
                 {"overall", 1},
                 {"virtual_time", session_.now()}});
}

void Walk::make(const Camera& camera) {
  camera_ = camera;
  display_.put_camera(json_of(camera));
  const auto part = [](std::uint32_t edge) { return (edge + kCoarse - 1) / kCoarse; };
  const std::vector<SamplePass> passes = refining_passes(samples_);
  if (!pass({camera, part(width_), part(height_), passes.front()})) return;
  show(1, true);
  for (const SamplePass& next : passes) {
    if (!pass({camera, width_, height_, next, next.first > 0})) return;
    show(next.first + next.count, false);
  }
}

}  // namespace torolux
