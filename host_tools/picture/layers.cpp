// SPDX-License-Identifier: MIT
// To look at: irradiance is tone mapped, depth becomes grey, normals and numbers become colours, cost glows like a hot
// body.
#include "host_tools/picture/layers.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/protocol/random.hpp"
#include "host_tools/picture/tone_map.hpp"

namespace torolux {
namespace {

using protocol::Plane;
using Bytes = std::array<std::uint8_t, 3>;

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

/// Neither black nor too near to another one's by more than chance.
Bytes colour_of(std::uint32_t number) {
  if (number == kNoNumber) return {0, 0, 0};
  Bytes bytes{};
  for (std::uint32_t c = 0; c < 3; ++c) {
    bytes[c] = static_cast<std::uint8_t>(56 + protocol::hash_combine(number, c) % 200);
  }
  return bytes;
}

/// Colours of a glowing body, 0..1.
Bytes heat(double value) {
  return {to_byte(3 * value), to_byte(3 * value - 1), to_byte(3 * value - 2)};
}

template <class Values, class Show>
std::vector<std::uint8_t> show_each(const Values& values, Show show) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size() * 3);
  for (const auto& value : values) {
    for (const std::uint8_t byte : show(value)) bytes.push_back(byte);
  }
  return bytes;
}

std::vector<std::uint8_t> show_depth(const Layer& layer) {
  constexpr double kFarthest = 0.2;
  double near = HUGE_VAL;
  double far = 0;
  for (const auto& value : layer.values) {
    if (!std::isfinite(value[0])) continue;
    near = std::min(near, double{value[0]});
    far = std::max(far, double{value[0]});
  }
  const double range = far > near ? far - near : 1;
  return show_each(layer.values, [=](const std::array<float, 3>& value) -> Bytes {
    if (!std::isfinite(value[0])) return {0, 0, 0};
    const std::uint8_t grey = to_byte(1 - (1 - kFarthest) * (double{value[0]} - near) / range);
    return {grey, grey, grey};
  });
}

Bytes show_normal(const std::array<float, 3>& normal) {
  if (normal == std::array<float, 3>{0, 0, 0}) return {0, 0, 0};
  return {to_byte((double{normal[0]} + 1) / 2), to_byte((double{normal[1]} + 1) / 2),
          to_byte((double{normal[2]} + 1) / 2)};
}

}  // namespace

std::string_view name_of(Plane layer) {
  return std::ranges::find(kLayerNames, layer, &LayerName::plane)->name;
}

std::vector<LayerName> layers_in(LayerSet set) {
  std::vector<LayerName> layers;
  for (const LayerName& layer : kLayerNames) {
    if ((set & protocol::plane_bit(layer.plane)) != 0) layers.push_back(layer);
  }
  return layers;
}

std::vector<LayerChannel> channels_of(const Layer& layer) {
  switch (layer.plane) {
    case Plane::irradiance:
      return {{"irradiance.R", 0}, {"irradiance.G", 1}, {"irradiance.B", 2}};
    case Plane::depth:
      return {{"depth.Z", 0}};
    case Plane::normals:
      return {{"N.X", 0}, {"N.Y", 1}, {"N.Z", 2}};
    case Plane::elements:
      return {{"element.id", 0}};
    case Plane::owner:
      return {{"owner.id", 0}};
    case Plane::cost:
      return {{"cost.subspaces", 0}};
    case Plane::colour:
      break;
  }
  return {};
}

std::vector<std::uint8_t> show_layer(const Layer& layer, std::uint32_t width, std::uint32_t height,
                                     const ToneMapping& mapping) {
  if (layer.plane == Plane::irradiance) return tone_map({width, height, layer.values}, mapping);
  if (layer.plane == Plane::depth) return show_depth(layer);
  if (layer.plane == Plane::normals) return show_each(layer.values, show_normal);
  if (layer.plane != Plane::cost) return show_each(layer.numbers, colour_of);
  const double most = std::max(1U, *std::ranges::max_element(layer.numbers));
  return show_each(layer.numbers, [most](std::uint32_t number) { return heat(std::sqrt(number / most)); });
}

}  // namespace torolux
