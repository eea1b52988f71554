// SPDX-License-Identifier: MIT
// Camera rays: from pixel and sample to origin, direction and the subspace where the ray begins. By the code of
// firmware/protocol/camera_ray.hpp, so that rays are the same wherever they are made.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/protocol/camera_ray.hpp"
#include "firmware/protocol/records.hpp"
#include "host_tools/camera/pixel_samples.hpp"
#include "host_tools/mesh/normalise.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/subspace/grid.hpp"

namespace torolux {

struct CameraRay {
  protocol::Vec3f origin;     ///< the eye, or a point of the lens, normalised
  protocol::Vec3f direction;  ///< unit length
  std::uint32_t key;          ///< random numbers: hash of (seed, pixel, sample)
};

class CameraRays {
 public:
  /// Throws InputError where the camera looks nowhere: eye at look_at, up along the view, field of view not 0..180. Of
  /// a camera with an aperture the plane that is sharp lies before the eye (camera_fault).
  CameraRays(const Camera& camera, const SceneSpace& space, std::uint32_t width, std::uint32_t height,
             PixelSamples samples, std::uint32_t seed);

  std::uint64_t count() const { return std::uint64_t{view_.width} * view_.height * view_.samples; }
  /// What a PE must have to make the same rays.
  const protocol::CameraView& view() const { return view_; }
  const PixelSamples& samples() const { return samples_; }
  /// pixel: row * width + column, row 0 on top. sample: below the view's number of them.
  CameraRay ray(std::uint32_t pixel, std::uint32_t sample) const;

 private:
  PixelSamples samples_;
  protocol::CameraView view_;
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
