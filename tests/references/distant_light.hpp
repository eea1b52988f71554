// SPDX-License-Identifier: MIT
// A scene's sky enters; what comes from a direction leaves, by angles and in double: nothing of the machine's is used
// but the order of the table's cells.
#pragma once

#include <Eigen/Core>
#include <array>

#include "host_tools/scene/scene.hpp"
#include "tests/references/scattering.hpp"

namespace torolux::references {

class DistantLight {
 public:
  /// sky: outlives it.
  explicit DistantLight(const Sky& sky);

  /// Without the sun; of the cell that holds the direction. direction: unit.
  Colour sky(const Vec& direction) const;
  /// The same, as it is shown: between the middles of cells in proportion, but not across the horizon.
  Colour sky_shown(const Vec& direction) const;
  /// Of the sun, where the direction is within its disc.
  Colour sun(const Vec& direction) const;
  bool has_sun() const { return sun_irradiance_.maxCoeff() > 0; }
  /// A direction within the disc, evenly.
  Vec to_sun(const std::array<double, 2>& place) const;
  /// Whether the scene names where light comes in: then the sky is asked for there, which changes nothing but noise.
  bool has_openings() const { return !from_.openings.empty(); }
  /// A direction from `point` to a place in an opening: the near and large ones more often. pick, place: in [0, 1).
  Vec to_opening(const Vec& point, double pick, const std::array<double, 2>& place) const;
  /// With which to_opening draws this direction [1/sr]; from the openings' outer sides nothing comes.
  double opening_density(const Vec& point, const Vec& direction) const;
  /// On a surface that faces the sun.
  const Colour& sun_irradiance() const { return sun_irradiance_; }

 private:
  double sector(const Vec& direction) const;

  const Sky& from_;
  Vec east_, north_, up_, sun_;
  Colour sun_irradiance_;
};

}  // namespace torolux::references
