// SPDX-License-Identifier: MIT
// A colour difference after the eye's blur, raised to a power that is the smaller, the more edges and points differ.
#include "host_tools/picture/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host_tools/picture/lightness.hpp"
#include "host_tools/picture/tone_map.hpp"

namespace torolux {
namespace {

using Colour = std::array<double, 3>;
using Planes = std::array<Plane, 3>;

constexpr double kColourExponent = 0.7;   ///< q_c
constexpr double kFeatureExponent = 0.5;  ///< q_f
constexpr double kKnee = 0.4;             ///< p_c: part of the greatest colour difference that is mapped to p_t
constexpr double kKneeValue = 0.95;       ///< p_t
constexpr double kFeatureWidth = 0.082;   ///< w: from peak to trough of the eye's edge detector [degrees]
constexpr double kReach = 3;              ///< of all filters, in standard deviations of the widest

/// One Gaussian of a contrast sensitivity function: a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct Sensitivity {
  double a, b;
};
/// Table 1 of the paper: achromatic, red-green, blue-yellow; what has one Gaussian has a second one of no height.
constexpr std::array<std::array<Sensitivity, 2>, 3> kSensitivities = {
    {{{{1, 0.0047}, {0, 1}}}, {{{1, 0.0053}, {0, 1}}}, {{{34.1, 0.04}, {13.5, 0.025}}}}};
constexpr double kWidest = 0.04;  ///< the largest b that counts

/// Standard deviation [degrees].
double width_of(const Sensitivity& s) {
  return std::sqrt(s.b / 2) / std::numbers::pi;
}

std::size_t pixel_count(const Picture& picture) {
  return picture.pixels.size();
}

/// Opponent colours Y C_x C_z, linear in XYZ.
Planes opponent_colours(const Picture& picture) {
  Planes planes;
  planes.fill(Plane(picture.width, picture.height));
  for (std::size_t i = 0; i < pixel_count(picture); ++i) {
    Colour linear{};
    for (std::size_t c = 0; c < 3; ++c) linear[c] = std::clamp(double{picture.pixels[i][c]}, 0.0, 1.0);
    const Colour xyz = relative_xyz(linear);
    planes[0].values[i] = static_cast<float>(116 * xyz[1] - 16);
    planes[1].values[i] = static_cast<float>(500 * (xyz[0] - xyz[1]));
    planes[2].values[i] = static_cast<float>(200 * (xyz[1] - xyz[2]));
  }
  return planes;
}

/// Blurred by the eye at this distance: the normalised sum of two Gaussians, each of one factor across and one down.
Plane seen(const Plane& plane, const std::array<Sensitivity, 2>& sensitivity, double pixels_per_degree) {
  const int reach = static_cast<int>(std::ceil(kReach * width_of({1, kWidest}) * pixels_per_degree));
  Plane result(plane.width, plane.height);
  std::array<double, 2> share{};
  for (std::size_t k = 0; k < 2; ++k) {
    const double sigma = width_of(sensitivity[k]) * pixels_per_degree;
    double sum = 0;
    for (int i = -reach; i <= reach; ++i) sum += std::exp(-i * i / (2 * sigma * sigma));
    share[k] = sensitivity[k].a * std::sqrt(std::numbers::pi / sensitivity[k].b) * sum * sum;
  }
  for (std::size_t k = 0; k < 2; ++k) {
    if (share[k] == 0) continue;
    const auto weights = gaussian_weights(width_of(sensitivity[k]) * pixels_per_degree, reach);
    const Plane blurred = filter(plane, weights, weights);
    const auto factor = static_cast<float>(share[k] / (share[0] + share[1]));
    for (std::size_t i = 0; i < result.values.size(); ++i) result.values[i] += factor * blurred.values[i];
  }
  return result;
}

/// L* a* b* with the colours of dark pixels paler (Hunt effect).
Colour hunt_lab(const Colour& relative) {
  const Colour lab = lab_of_xyz(relative);
  return {lab[0], 0.01 * lab[0] * lab[1], 0.01 * lab[0] * lab[2]};
}

/// HyAB distance: city blocks between lightness and colour.
double distance(const Colour& a, const Colour& b) {
  return std::fabs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// Of a pixel of blurred opponent colours, cut off at what a display can show.
Colour colour_of(const Planes& seen_planes, std::size_t i) {
  const double y = (double{seen_planes[0].values[i]} + 16) / 116;
  Colour linear =
      linear_of_xyz({y + double{seen_planes[1].values[i]} / 500, y, y - double{seen_planes[2].values[i]} / 200});
  for (double& channel : linear) channel = std::clamp(channel, 0.0, 1.0);
  return hunt_lab(relative_xyz(linear));
}

/// 0..1: small differences spread over most of the range, the greatest (green against blue) becomes 1.
double spread(double difference) {
  static const double greatest =
      std::pow(distance(hunt_lab(relative_xyz({0, 1, 0})), hunt_lab(relative_xyz({0, 0, 1}))), kColourExponent);
  const double power = std::pow(difference, kColourExponent);
  const double knee = kKnee * greatest;
  if (power < knee) return kKneeValue / knee * power;
  return std::min(1.0, kKneeValue + (power - knee) / (greatest - knee) * (1 - kKneeValue));
}

Plane colour_difference(const Planes& picture, const Planes& reference, double pixels_per_degree) {
  Planes a, b;
  for (std::size_t c = 0; c < 3; ++c) {
    a[c] = seen(picture[c], kSensitivities[c], pixels_per_degree);
    b[c] = seen(reference[c], kSensitivities[c], pixels_per_degree);
  }
  Plane result(a[0].width, a[0].height);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    result.values[i] = static_cast<float>(spread(distance(colour_of(a, i), colour_of(b, i))));
  }
  return result;
}

/// Positive weights add up to 1, negative ones to -1.
void balance(std::vector<double>& weights) {
  double positive = 0;
  double negative = 0;
  for (const double weight : weights) (weight > 0 ? positive : negative) += std::fabs(weight);
  for (double& weight : weights) weight /= weight > 0 ? positive : negative;
}

/// How strongly each pixel looks like an edge (derivative of a Gaussian) and like a point or line (second derivative).
struct Features {
  Plane edges, points;
};

Plane length_of_both(const Plane& plane, const std::vector<double>& derivative, const std::vector<double>& blur) {
  Plane result = filter(plane, derivative, blur);
  const Plane down = filter(plane, blur, derivative);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    result.values[i] = std::hypot(result.values[i], down.values[i]);
  }
  return result;
}

Features features_of(const Plane& achromatic, double pixels_per_degree) {
  Plane normalised = achromatic;
  for (float& value : normalised.values) value = (value + 16) / 116;
  const double sigma = 0.5 * kFeatureWidth * pixels_per_degree;
  const int reach = static_cast<int>(std::ceil(kReach * sigma));
  const std::vector<double> blur = gaussian_weights(sigma, reach);
  std::vector<double> edge, point;
  int offset = -reach;
  for (const double weight : blur) {
    edge.push_back(-offset * weight);
    point.push_back((offset * offset / (sigma * sigma) - 1) * weight);
    ++offset;
  }
  balance(edge);
  balance(point);
  return {length_of_both(normalised, edge, blur), length_of_both(normalised, point, blur)};
}

/// The paper's curve (K. Narkowicz's approximation of ACES, 2016): x (a x + b) / (x (c x + d) + e), cut off at 1, with
/// the exposure of 0.6 that it was fitted for.
struct AcesCurve {
  static constexpr double a = 0.36 * 2.51, b = 0.6 * 0.03, c = 0.36 * 2.43, d = 0.6 * 0.59, e = 0.14;
  static double value(double x) {
    if (!(x < 1e100)) return 1;
    return std::clamp(x * (a * x + b) / (x * (c * x + d) + e), 0.0, 1.0);
  }
  /// Where the curve has the value t: the positive root of a quadratic equation.
  static double inverse(double t) {
    const double half = (b - d * t) / (2 * (a - c * t));
    return -half + std::sqrt(half * half + e * t / (a - c * t));
  }
};

Picture shown_at(const Picture& picture, double factor) {
  Picture shown = picture;
  for (auto& pixel : shown.pixels) {
    for (float& channel : pixel) {
      channel = static_cast<float>(AcesCurve::value(factor * std::max(double{channel}, 0.0)));
    }
  }
  return shown;
}

struct ExposureRange {
  double first, last;  ///< [EV]
};

/// From where the brightest pixel is well exposed to where the median one is.
ExposureRange exposures_of(const Picture& reference) {
  constexpr double kWellExposed = 0.85;
  std::vector<double> luminances;
  luminances.reserve(reference.pixels.size());
  for (const auto& pixel : reference.pixels) {
    luminances.push_back(luminance(pixel));
  }
  const double brightest = *std::ranges::max_element(luminances);
  if (!(brightest > 0)) return {0, 0};
  const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
  std::ranges::nth_element(luminances, middle);
  const double x = AcesCurve::inverse(kWellExposed);
  const double first = std::log2(x / brightest);
  // More than half of the picture black: as many exposures as there are stops in a display.
  return {first, *middle > 0 ? std::log2(x / *middle) : first + 8};
}

}  // namespace

Plane flip(const Picture& shown, const Picture& reference, double pixels_per_degree) {
  const Planes a = opponent_colours(shown);
  const Planes b = opponent_colours(reference);
  Plane result = colour_difference(a, b, pixels_per_degree);
  const Features features = features_of(a[0], pixels_per_degree);
  const Features reference_features = features_of(b[0], pixels_per_degree);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    const double edge = std::fabs(double{features.edges.values[i]} - double{reference_features.edges.values[i]});
    const double point = std::fabs(double{features.points.values[i]} - double{reference_features.points.values[i]});
    const double feature = std::pow(std::max(edge, point) / std::numbers::sqrt2, kFeatureExponent);
    result.values[i] = static_cast<float>(std::pow(double{result.values[i]}, 1 - feature));
  }
  return result;
}

Plane hdr_flip(const Picture& picture, const Picture& reference, double pixels_per_degree) {
  const ExposureRange range = exposures_of(reference);
  const auto count = static_cast<int>(std::max(2.0, std::ceil(range.last - range.first)));
  Plane worst(picture.width, picture.height);
  for (int i = 0; i < count; ++i) {
    const double factor = std::exp2(range.first + i * (range.last - range.first) / (count - 1));
    const Plane one = flip(shown_at(picture, factor), shown_at(reference, factor), pixels_per_degree);
    for (std::size_t p = 0; p < worst.values.size(); ++p) worst.values[p] = std::max(worst.values[p], one.values[p]);
  }
  return worst;
}

Pooled pool(const Plane& plane) {
  Pooled pooled;
  double sum = 0;
  for (const float value : plane.values) sum += double{value};
  pooled.mean = sum / static_cast<double>(plane.values.size());
  const auto worst = static_cast<std::size_t>(std::ranges::max_element(plane.values) - plane.values.begin());
  pooled.worst = double{plane.values[worst]};
  pooled.worst_x = static_cast<std::uint32_t>(worst % plane.width);
  pooled.worst_y = static_cast<std::uint32_t>(worst / plane.width);
  std::vector<float> values = plane.values;
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.95 * static_cast<double>(values.size()))) - 1;
  std::ranges::nth_element(values, values.begin() + rank);
  pooled.percentile_95 = double{values[static_cast<std::size_t>(rank)]};
  return pooled;
}

}  // namespace torolux
