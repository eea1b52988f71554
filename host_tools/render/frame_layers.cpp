// SPDX-License-Identifier: MIT
// Sums times the value of a quantum; depths as means, normals made unit. Polygon and location code, as the PE named
// them, become an element's number.
#include "host_tools/render/frame_layers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/files/digest.hpp"

namespace torolux {
namespace {

using protocol::Plane;

constexpr double kUnit = double{protocol::kLayerUnit};

std::array<float, 3> scaled(const PixelSums& sums, double unit) {
  return {static_cast<float>(static_cast<double>(sums[0]) * unit),
          static_cast<float>(static_cast<double>(sums[1]) * unit),
          static_cast<float>(static_cast<double>(sums[2]) * unit)};
}

/// Each sample weighs as if its pixel had all that it may have.
class Shares {
 public:
  Shares(const SampleCounts& samples, const RenderSetup& setup)
      : samples_(samples), all_(setup.parameters.pixel_samples) {}
  double of(std::size_t pixel) const {
    return samples_.empty() ? 1 : static_cast<double>(all_) / std::max(1U, samples_[pixel]);
  }

 private:
  const SampleCounts& samples_;
  std::uint32_t all_;
};

/// Mean over the samples that met something.
std::array<float, 3> depth(const PixelSums& sums, double edge) {
  if (sums[1] == 0) return {std::numeric_limits<float>::infinity(), 0, 0};
  return {static_cast<float>(static_cast<double>(sums[0]) * kUnit * edge / static_cast<double>(sums[1])), 0, 0};
}

std::array<float, 3> normal(const PixelSums& sums) {
  const double length = std::hypot(static_cast<double>(sums[0]), static_cast<double>(sums[1]),  //
                                   static_cast<double>(sums[2]));
  return scaled(sums, length > 0 ? 1 / length : 0);
}

/// Global number of the element that firmware/pe/layers.cpp names by polygon, location code and side.
std::uint32_t element_number(const PixelSums& name, const Mesh& mesh) {
  if (name[0] == 0 || name[1] <= 0) return kNoNumber;
  const auto t = static_cast<std::uint32_t>(name[0] - 1);
  const auto code = static_cast<std::uint32_t>(name[1]);
  const MeshTriangle& triangle = mesh.triangles.at(t);
  const std::uint32_t below = protocol::level_of_code(code) - triangle.patch_level;
  const std::uint32_t path = protocol::path_of_code(code) >> (2U * below);
  const MeshPatch& patch = mesh.patches[mesh.parts.at(triangle.first_part + path).patch];
  const auto middle = protocol::middle_of_grid_triangle(protocol::path_of_code(code), protocol::level_of_code(code));
  constexpr float unit = 1.0F / (3.0F * (1U << protocol::kMostLevels));
  const std::uint32_t facet =
      mesh.facet_at(t, unit * static_cast<float>(middle[1]), unit * static_cast<float>(middle[2]));
  return patch.first_element.at(static_cast<std::size_t>(name[2])) + mesh.facets[facet].element;
}

std::uint32_t number(std::int64_t value) {
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(value, 0, kNoNumber - 1));
}

Layer layer_of(Plane plane, const std::vector<PixelSums>& sums, const RenderSetup& setup, const Shares& shares) {
  Layer layer{plane, {}, {}};
  const double to_irradiance = setup.radiance_per_quantum() * std::numbers::pi;
  const double edge = 1 / setup.mesh.space.scale;
  for (const PixelSums& pixel : sums) {
    switch (plane) {
      case Plane::irradiance:
        layer.values.push_back(scaled(pixel, to_irradiance * shares.of(layer.values.size())));
        break;
      case Plane::depth:
        layer.values.push_back(depth(pixel, edge));
        break;
      case Plane::normals:
        layer.values.push_back(normal(pixel));
        break;
      case Plane::elements:
        layer.numbers.push_back(element_number(pixel, setup.mesh));
        break;
      case Plane::owner:
        layer.numbers.push_back(pixel[0] == 0 ? kNoNumber : number(pixel[0] - 1));
        break;
      case Plane::cost:
        layer.numbers.push_back(number(pixel[0]));
        break;
      case Plane::colour:
        break;
    }
  }
  return layer;
}

}  // namespace

Picture picture_of(const FrameBuffer& frame_buffer, const RenderSetup& setup, const SampleCounts& samples) {
  Picture picture{frame_buffer.width, frame_buffer.height, {}};
  const std::vector<PixelSums>& sums = frame_buffer.plane(Plane::colour);
  picture.pixels.reserve(sums.size());
  const double unit = setup.radiance_per_quantum();
  const Shares shares(samples, setup);
  for (const PixelSums& pixel : sums) picture.pixels.push_back(scaled(pixel, unit * shares.of(picture.pixels.size())));
  return picture;
}

std::vector<Layer> layers_of(const FrameBuffer& frame_buffer, const RenderSetup& setup, const SampleCounts& samples) {
  const Shares shares(samples, setup);
  std::vector<Layer> layers;
  for (const LayerName& layer : layers_in(setup.parameters.layers)) {
    layers.push_back(layer_of(layer.plane, frame_buffer.plane(layer.plane), setup, shares));
  }
  return layers;
}

std::string digest_of(const FrameBuffer& frame_buffer, Plane plane) {
  static_assert(std::endian::native == std::endian::little);
  Sha256 digest;
  const std::array<std::uint64_t, 2> size{frame_buffer.width, frame_buffer.height};
  digest.add(std::as_bytes(std::span(size)));
  digest.add(std::as_bytes(std::span(frame_buffer.plane(plane))));
  return digest.hexadecimal();
}

}  // namespace torolux
