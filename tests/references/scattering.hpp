// SPDX-License-Identifier: MIT
// What surfaces do with light, for the path tracer: directions in; reflected fractions, densities and directions out.
#pragma once

#include "tests/references/world.hpp"

namespace torolux::references {

/// A diffuse or glossy surface seen from one side: f = kd / pi + ks (n + 2) / (2 pi) cos^n(alpha), alpha between the
/// mirrored view and the outgoing direction (Lafortune & Willems 1994, "Using the modified Phong reflectance model for
/// physically based rendering"). It reflects at most kd + ks.
class Reflection {
 public:
  /// normal: unit, on the side that is seen. mirrored: unit, the direction about which the lobe lies.
  Reflection(const Vec& normal, const Vec& mirrored, const Colour& diffuse, const Colour& specular, double exponent);

  /// f(view, out); 0 for directions below the surface. out: unit.
  Colour value(const Vec& out) const;
  /// Of sample(), per solid angle [1/sr].
  double density(const Vec& out) const;
  /// May point below the surface (glossy): such a path has ended. choice, place: uniform in [0, 1).
  Vec sample(double choice, const std::array<double, 2>& place) const;
  double cosine(const Vec& out) const { return normal_.dot(out); }

 private:
  Vec normal_;
  Vec mirrored_;
  Colour diffuse_, specular_;
  double exponent_;
  double specular_chance_;  // of sample() taking the lobe
};

/// A unit vector at cosine `cosine` from `axis`, turned by `turn` (0..1 of a circle).
Vec around(const Vec& axis, double cosine, double turn);

/// The law of reflection with an interpolated normal; where that would lead through the flat polygon, with its own.
/// in: unit, towards the surface; normals of either sign.
Vec mirror(const Vec& in, const Vec& geometric, const Vec& shading);

struct GlassWays {
  double reflectance;  ///< Fresnel's, unpolarised; 1: total reflection
  Vec refracted;       ///< unit; means nothing at total reflection
};

/// eta: refractive index of the side that the light comes from over the other's. Born & Wolf, Principles of
/// Optics, 1.5.
GlassWays glass(const Vec& in, const Vec& geometric, const Vec& shading, double eta);

/// Parts of the light that comes, both faces and all reflections between them taken together.
struct PaneParts {
  Colour reflected, passed;

  /// Of a path that takes one of the two ways by chance.
  double chance_to_reflect() const { return reflected.maxCoeff() / (reflected.maxCoeff() + passed.maxCoeff()); }
};

PaneParts pane(const Vec& in, const Vec& geometric, const Material& material);

}  // namespace torolux::references
