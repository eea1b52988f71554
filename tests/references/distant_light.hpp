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
  /// Of the sun, where the direction is within its disc.
  Colour sun(const Vec& direction) const;
  bool has_sun() const { return sun_irradiance_.maxCoeff() > 0; }
  /// A direction within the disc, evenly.
  Vec to_sun(const std::array<double, 2>& place) const;
  /// On a surface that faces the sun.
  const Colour& sun_irradiance() const { return sun_irradiance_; }

 private:
  const Sky& from_;
  Vec east_, north_, up_, sun_;
  Colour sun_irradiance_;
};

}  // namespace torolux::references
