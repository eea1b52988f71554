// SPDX-License-Identifier: MIT
// Least squares, linear in normal and place, with a ridge for each; solved by Cholesky's factors. What is read off a
// fit stays between the least and the greatest sample.
#include "host_tools/irradiance/irradiance_fit.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Added to the variance of normals and places: little against that of a curved surface, much against a flat one's.
/// Where normals only change along with places, as on a ball, they share out which of both explains the light. Tuned on
/// the bunny's picture; half or twice of each makes little difference.
constexpr double kNormalRidge = 0.005;
constexpr double kPlaceRidge = 0.05;

/// What irradiance depends on: normal and place.
constexpr std::size_t kTerms = 6;
using Terms = std::array<double, kTerms>;

Terms terms_of(const Vec3d& normal, const Vec3d& offset) {
  return {normal[0], normal[1], normal[2], offset[0], offset[1], offset[2]};
}

/// The lower left of a symmetric, positive definite matrix.
using Matrix = std::array<Terms, kTerms>;

/// Leaves the factor L of L L^T = matrix.
void factorise(Matrix& matrix) {
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = matrix[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= matrix[i][k] * matrix[j][k];
      matrix[i][j] = i == j ? std::sqrt(sum) : sum / matrix[j][j];
    }
  }
}

Terms solve(const Matrix& factor, Terms right) {
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t k = 0; k < i; ++k) right[i] -= factor[i][k] * right[k];
    right[i] /= factor[i][i];
  }
  for (std::size_t i = kTerms; i-- > 0;) {
    for (std::size_t k = i + 1; k < kTerms; ++k) right[i] -= factor[k][i] * right[k];
    right[i] /= factor[i][i];
  }
  return right;
}

}  // namespace

Vec3d IrradianceFit::facing(const Vec3d& unit_normal) const {
  const Vec3d turned = vec::subtract(unit_normal, normal);
  Vec3d light{};
  for (std::size_t c = 0; c < 3; ++c) light[c] = std::clamp(value[c] + vec::dot(slope[c], turned), least[c], most[c]);
  return light;
}

IrradianceFit fit_irradiance(std::span<const IrradianceSample> samples) {
  IrradianceFit fit;
  double weight = 0;
  Terms mean{};
  for (const IrradianceSample& sample : samples) {
    const Terms terms = terms_of(sample.normal, sample.offset);
    weight += sample.weight;
    for (std::size_t i = 0; i < kTerms; ++i) mean[i] += sample.weight * terms[i];
    fit.value = vec::add(fit.value, vec::scale(sample.irradiance, sample.weight));
  }
  if (!(weight > 0)) return fit;
  for (double& term : mean) term /= weight;
  fit.value = vec::scale(fit.value, 1 / weight);
  Matrix matrix{};
  std::array<Terms, 3> right{};
  fit.least = fit.most = samples.front().irradiance;
  for (const IrradianceSample& sample : samples) {
    Terms terms = terms_of(sample.normal, sample.offset);
    for (std::size_t i = 0; i < kTerms; ++i) terms[i] -= mean[i];
    for (std::size_t i = 0; i < kTerms; ++i) {
      for (std::size_t j = 0; j <= i; ++j) matrix[i][j] += sample.weight * terms[i] * terms[j];
      for (std::size_t c = 0; c < 3; ++c)
        right[c][i] += sample.weight * terms[i] * (sample.irradiance[c] - fit.value[c]);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      fit.least[c] = std::min(fit.least[c], sample.irradiance[c]);
      fit.most[c] = std::max(fit.most[c], sample.irradiance[c]);
    }
  }
  for (std::size_t i = 0; i < kTerms; ++i) matrix[i][i] += weight * (i < 3 ? kNormalRidge : kPlaceRidge);
  factorise(matrix);
  fit.normal = {mean[0], mean[1], mean[2]};
  for (std::size_t c = 0; c < 3; ++c) {
    const Terms slope = solve(matrix, right[c]);
    fit.slope[c] = {slope[0], slope[1], slope[2]};
    // The place itself has offset 0.
    for (std::size_t i = 3; i < kTerms; ++i) fit.value[c] -= slope[i] * mean[i];
  }
  return fit;
}

}  // namespace torolux
