// SPDX-License-Identifier: MIT
// Camera rays: from pixel and sample to origin, direction and the subspace where the ray begins.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/protocol/records.hpp"
#include "host_tools/mesh/normalise.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/stages/pixel_samples.hpp"
#include "host_tools/subspace/grid.hpp"

namespace torolux {

struct CameraRay {
  protocol::Vec3f origin;     ///< the eye, normalised
  protocol::Vec3f direction;  ///< unit length
  std::uint32_t key;          ///< random numbers: hash of (seed, pixel, sample)
};

class CameraRays {
 public:
  /// Throws InputError where the camera looks nowhere: eye at look_at, up along the view, field of view not 0..180.
  CameraRays(const Camera& camera, const SceneSpace& space, std::uint32_t width, std::uint32_t height,
             PixelSamples samples, std::uint32_t seed);

  std::uint64_t count() const { return std::uint64_t{width_} * height_ * samples_.count(); }
  std::size_t table_entries() const { return samples_.table_entries(); }
  /// pixel: row * width + column, row 0 on top.
  CameraRay ray(std::uint32_t pixel, std::uint32_t sample) const;

 private:
  std::uint32_t width_, height_, seed_;
  PixelSamples samples_;
  protocol::Vec3f eye_;
  Vec3d forward_, right_, down_;  ///< right and down reach from the middle to the edge of the picture
};

struct FirstSubspace {
  CellIndex cell;
  std::uint8_t flags;  ///< kFirst, or the axis of the face through which the ray enters
};

/// Where a ray's walk begins: the cell of its origin, or the one where it enters the object space; nothing where it
/// misses that. By the PEs' own formulas, in float. filled: where given, the first cell on the way with anything in it
/// (by cell); nothing where there is none. entered: where given, grows by the subspaces of the walk.
std::optional<FirstSubspace> first_subspace(const Grid& grid, const protocol::Vec3f& origin,
                                            const protocol::Vec3f& direction, const std::vector<bool>* filled,
                                            std::uint64_t* entered = nullptr);

}  // namespace torolux
