// SPDX-License-Identifier: MIT
// How irradiance varies around a place of a curved surface. Enters: what elements near it received; leaves: irradiance
// there for any normal.
#pragma once

#include <array>
#include <span>

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// What one element says about the light around a place. Where irradiance is linear in normal and place, an element's
/// is that at the means of both.
struct IrradianceSample {
  Vec3d normal{0, 0, 0};      ///< mean of the element's unit normals, itself shorter than 1
  Vec3d offset{0, 0, 0};      ///< of the element's centre from the place, in units of how far samples are taken
  Vec3d irradiance{0, 0, 0};  ///< any unit
  double weight = 0;
};

/// Irradiance at a place as a linear function of the normal.
struct IrradianceFit {
  Vec3d normal{0, 0, 0};         ///< where `value` holds
  Vec3d value{0, 0, 0};          ///< by channel
  std::array<Vec3d, 3> slope{};  ///< by channel, over the normal
  Vec3d least{0, 0, 0};          ///< no normal gets less, by channel
  Vec3d most{0, 0, 0};

  Vec3d facing(const Vec3d& unit_normal) const;
};

/// Irradiance changes with place and normal by gradients of their own (Ward & Heckbert 1992, "Irradiance gradients").
/// Weighted least squares with a ridge (Hoerl & Kennard 1970) find both from all samples together: what the samples do
/// not determine, as on a plane or with one sample alone, stays their mean. No samples: zero.
IrradianceFit fit_irradiance(std::span<const IrradianceSample> samples);

}  // namespace torolux
