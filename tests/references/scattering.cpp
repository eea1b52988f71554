// SPDX-License-Identifier: MIT
// Lobe or diffuse part is chosen by their greatest channels. Mirror and glass take the geometric normal where the
// shading normal would send light to the wrong side.
#include "tests/references/scattering.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace torolux::references {
namespace {

constexpr double kPi = std::numbers::pi;

Vec mirrored(const Vec& in, const Vec& normal) {
  return (in - 2 * in.dot(normal) * normal).normalized();
}

/// The sign of a normal that faces the light which comes along `in`.
Vec facing(const Vec& normal, const Vec& in) {
  return in.dot(normal) > 0 ? Vec(-normal) : normal;
}

GlassWays at_interface(const Vec& in, const Vec& normal, double eta) {
  const double cos_in = -in.dot(normal);
  const double sin2_out = eta * eta * (1 - cos_in * cos_in);
  if (sin2_out >= 1 || cos_in <= 0) return {1, in};
  const double cos_out = std::sqrt(1 - std::max(0.0, sin2_out));
  // n1 = eta, n2 = 1: only their ratio counts.
  const double s = (eta * cos_in - cos_out) / (eta * cos_in + cos_out);
  const double p = (eta * cos_out - cos_in) / (eta * cos_out + cos_in);
  return {(s * s + p * p) / 2, (eta * in + (eta * cos_in - cos_out) * normal).normalized()};
}

}  // namespace

Vec around(const Vec& axis, double cosine, double turn) {
  // Duff et al. 2017, "Building an orthonormal basis, revisited".
  const double sign = std::copysign(1.0, axis.z());
  const double a = -1 / (sign + axis.z());
  const double b = axis.x() * axis.y() * a;
  const Vec x(1 + sign * axis.x() * axis.x() * a, sign * b, -sign * axis.x());
  const Vec y(b, sign + axis.y() * axis.y() * a, -axis.y());
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return x * (sine * std::cos(2 * kPi * turn)) + y * (sine * std::sin(2 * kPi * turn)) + axis * cosine;
}

Reflection::Reflection(const Vec& normal, const Vec& mirrored, const Colour& diffuse, const Colour& specular,
                       double exponent)
    : normal_(normal), mirrored_(mirrored), diffuse_(diffuse), specular_(specular), exponent_(exponent) {
  const double both = diffuse.maxCoeff() + specular.maxCoeff();
  specular_chance_ = both > 0 ? specular.maxCoeff() / both : 0;
}

Colour Reflection::value(const Vec& out) const {
  if (cosine(out) <= 0) return Colour::Zero();
  Colour result = diffuse_ / kPi;
  if (specular_chance_ > 0) {
    result += specular_ * ((exponent_ + 2) / (2 * kPi) * std::pow(std::max(0.0, mirrored_.dot(out)), exponent_));
  }
  return result;
}

double Reflection::density(const Vec& out) const {
  const double diffuse = std::max(0.0, cosine(out)) / kPi;
  if (specular_chance_ == 0) return diffuse;
  const double lobe = (exponent_ + 1) / (2 * kPi) * std::pow(std::max(0.0, mirrored_.dot(out)), exponent_);
  return (1 - specular_chance_) * diffuse + specular_chance_ * lobe;
}

Vec Reflection::sample(double choice, const std::array<double, 2>& place) const {
  const double height = 1 - place[0];
  return choice < specular_chance_ ? around(mirrored_, std::pow(height, 1 / (exponent_ + 1)), place[1])
                                   : around(normal_, std::sqrt(height), place[1]);
}

Vec mirror(const Vec& in, const Vec& geometric, const Vec& shading) {
  const Vec out = mirrored(in, shading);
  const Vec flat = facing(geometric, in);
  return out.dot(flat) > 0 ? out : mirrored(in, flat);
}

GlassWays glass(const Vec& in, const Vec& geometric, const Vec& shading, double eta) {
  const Vec flat = facing(geometric, in);
  Vec round = shading.dot(flat) < 0 ? Vec(-shading) : shading;
  if (in.dot(round) >= 0) round = flat;
  GlassWays ways = at_interface(in, round, eta);
  if (ways.reflectance < 1 && ways.refracted.dot(flat) >= 0) return at_interface(in, flat, eta);
  return ways;
}

PaneParts pane(const Vec& in, const Vec& geometric, const Material& material) {
  const double face = at_interface(in, facing(geometric, in), 1 / material.refractive_index).reflectance;
  PaneParts parts{Colour::Constant(face), Colour::Zero()};
  // Light between the faces, from one reflection to the next, until nothing is left of it.
  for (Colour inside = (1 - face) * material.transmittance; (inside > 1e-12).any();) {
    parts.passed += inside * (1 - face);
    inside *= face * material.transmittance;
    parts.reflected += inside * (1 - face);
    inside *= face * material.transmittance;
  }
  return parts;
}

}  // namespace torolux::references
