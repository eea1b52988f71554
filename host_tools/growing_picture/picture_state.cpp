// SPDX-License-Identifier: MIT
// Pixels into planes.
#include "host_tools/growing_picture/picture_state.hpp"

#include "host_tools/render/frame_layers.hpp"

namespace torolux {
namespace {

NamedPlane plane_of(const std::string& channel, const std::vector<std::array<float, 3>>& pixels,
                    std::size_t component) {
  NamedPlane plane{channel, {}};
  plane.values.reserve(pixels.size());
  for (const auto& pixel : pixels) plane.values.push_back(pixel.at(component));
  return plane;
}

NamedPlane plane_of(const std::string& channel, const std::vector<std::uint32_t>& numbers) {
  NamedPlane plane{channel, {}};
  plane.values.reserve(numbers.size());
  for (const std::uint32_t number : numbers)
    plane.values.push_back(number == kNoNumber ? -1.0F : static_cast<float>(number));
  return plane;
}

}  // namespace

PictureState picture_state(const RunningRender& running) {
  const FrameBuffer& sums = running.machine.frame_buffer();
  const SampleCounts& samples = running.program.samples();
  return {picture_of(sums, running.setup, samples), layers_of(sums, running.setup, samples)};
}

std::vector<NamedPlane> planes_of(const PictureState& state) {
  std::vector<NamedPlane> planes;
  constexpr std::array<const char*, 3> kColours{"R", "G", "B"};
  for (std::size_t i = 0; i < kColours.size(); ++i) planes.push_back(plane_of(kColours.at(i), state.picture.pixels, i));
  for (const Layer& layer : state.layers) {
    for (const LayerChannel& channel : channels_of(layer))
      planes.push_back(layer.numbers.empty() ? plane_of(channel.name, layer.values, channel.component)
                                             : plane_of(channel.name, layer.numbers));
  }
  return planes;
}

}  // namespace torolux
