// SPDX-License-Identifier: MIT
// Values are checked, then asked of an inspector; a pixel's story costs one view of one sample.
#include "host_tools/display/questions.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/inspect/answer_json.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMostNumber = 0xFFFF'FFFE;

std::uint32_t number_of(const nlohmann::json& value, const char* what) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMostNumber)
    throw InputError(std::string(what) + " is no whole number from 0");
  return value.get<std::uint32_t>();
}

FollowedPixel pixel_of(const nlohmann::json& value, const Quality& quality) {
  if (!value.is_array() || value.size() < 2 || value.size() > 3)
    throw InputError("a pixel is [column, row] or [column, row, sample]");
  FollowedPixel pixel{number_of(value[0], "a column"), number_of(value[1], "a row")};
  if (value.size() == 3) pixel.sample = number_of(value[2], "a sample");
  if (pixel.column >= quality.width || pixel.row >= quality.height || pixel.sample >= quality.samples)
    throw InputError("the picture has " + std::to_string(quality.width) + " x " + std::to_string(quality.height) +
                     " pixels of " + std::to_string(quality.samples) + " samples, all counted from 0");
  return pixel;
}

/// Pixels, row by row, of which `good` says so: [first, count], ...
template <class Good>
Json runs_of(const ElementView& view, Good good) {
  Json runs = Json::array();
  const auto sights = view.sights();
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (!good(sights[i])) continue;
    const std::size_t first = i;
    while (i + 1 < sights.size() && good(sights[i + 1])) ++i;
    runs.push_back({first, i + 1 - first});
  }
  return runs;
}

}  // namespace

Questions::Questions(const Scene& scene, const Quality& quality, const MachineChoice& machine, RenderSession& session)
    : scene_(scene),
      quality_(quality),
      machine_(machine),
      session_(session),
      figures_(session.machine().figures()),
      picture_(session.picture(quality.samples)) {}

bool Questions::asks_machine(const nlohmann::json& question) {
  return question.contains("pixel");
}

const Inspector& Questions::inspector(const Camera& camera) {
  if (!inspector_ || camera != camera_) {
    inspector_.reset();
    camera_ = camera;
    inspector_.emplace(Inspected{scene_, camera_, quality_, machine_, session_.setup(), session_.solution(), figures_});
  }
  return *inspector_;
}

Json Questions::element(const nlohmann::json& value, const Camera& camera) {
  std::optional<std::uint32_t> number;
  if (value.is_array()) {
    const FollowedPixel pixel = pixel_of(value, quality_);
    number = inspector(camera).element_at(pixel.column, pixel.row);
    if (!number) return {{"element", nullptr}};
  } else {
    number = number_of(value, "an element");
  }
  const Inspector& asked = inspector(camera);
  Json answer = answer_json(asked.element(*number));
  answer["seen"] =
      runs_of(asked.view(), [&](const Sight& sight) { return sight.element && sight.element->element == *number; });
  return {{"element", std::move(answer)}};
}

/// Where a PE's subspaces are seen; where all PEs have all of them, the patches that it owns.
Json Questions::pe(const nlohmann::json& value, const Camera& camera) {
  const unsigned number = number_of(value, "a PE");
  const Inspector& asked = inspector(camera);
  Json answer = answer_json(asked.pe(number, {}));
  answer.erase("last_packets");
  const Placement& rays = session_.setup().ray_placement;
  const Placement& light = session_.setup().placement;
  const bool common = rays.cells_of_pe.at(number).size() <= rays.common_cells;
  answer["seen_as"] = common ? "patches" : "subspaces";
  answer["seen"] = runs_of(asked.view(), [&](const Sight& sight) {
    if (common) return sight.element && light.patch_home[sight.element->patch].pe == number;
    return sight.first_cell && !rays.common_cell[*sight.first_cell] && rays.pe_of_cell[*sight.first_cell] == number;
  });
  return {{"pe", std::move(answer)}};
}

Json Questions::pixel(const nlohmann::json& value, const Camera& camera, const std::function<bool()>& wanted) {
  const FollowedPixel pixel = pixel_of(value, quality_);
  Story story(pixel);
  const View view{camera, quality_.width, quality_.height, {pixel.sample, 1, 1}};
  if (!session_.view(view, wanted, &story)) throw InputError("something newer has been asked for");
  return {{"pixel", answer_json(inspector(camera).pixel(pixel, story, picture_))}};
}

Json Questions::answer(const nlohmann::json& question, const Camera& camera, const std::function<bool()>& wanted) {
  try {
    if (question.contains("element")) return element(question["element"], camera);
    if (question.contains("pe")) return pe(question["pe"], camera);
    if (question.contains("pixel")) return pixel(question["pixel"], camera, wanted);
    throw InputError("a question is about an element, a pe or a pixel");
  } catch (const InputError& error) {
    return {{"error", error.what()}};
  }
}

}  // namespace torolux
