// SPDX-License-Identifier: MIT
// A pyramid of the error; each level's band, its structure tensor averaged over a neighbourhood some details wide.
#include "host_tools/picture/streaks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/picture/lightness.hpp"

namespace torolux {
namespace {

constexpr unsigned kBands = 4;
constexpr std::uint32_t kLeastEdge = 16;  ///< a band of fewer pixels than this across says nothing about directions
/// Standard deviations in pixels of the level: what a band keeps lies between the first two.
constexpr double kFine = 0.7, kCoarse = 1.4, kNeighbourhood = 6;
/// Mean coherence of white noise with these, as the slopes in a neighbourhood never cancel wholly (streaks_test.cpp).
constexpr double kCoherenceOfNoise = 0.013;

Plane blurred(const Plane& plane, double sigma) {
  const std::vector<double> weights = gaussian_weights(sigma, static_cast<int>(std::ceil(3 * sigma)));
  return filter(plane, weights, weights);
}

Plane band_of(const Plane& level) {
  Plane band = blurred(level, kFine);
  const Plane coarse = blurred(level, kCoarse);
  for (std::size_t i = 0; i < band.values.size(); ++i) band.values[i] -= coarse.values[i];
  return band;
}

/// xx, xy, yy of the slopes' products, averaged over the neighbourhood.
std::array<Plane, 3> structure_tensor(const Plane& band) {
  constexpr std::array<double, 3> kSlope = {-0.5, 0, 0.5};
  constexpr std::array<double, 3> kNone = {0, 1, 0};
  const Plane across = filter(band, kSlope, kNone);
  const Plane down = filter(band, kNone, kSlope);
  std::array<Plane, 3> tensor;
  tensor.fill(Plane(band.width, band.height));
  for (std::size_t i = 0; i < band.values.size(); ++i) {
    tensor[0].values[i] = across.values[i] * across.values[i];
    tensor[1].values[i] = across.values[i] * down.values[i];
    tensor[2].values[i] = down.values[i] * down.values[i];
  }
  for (Plane& product : tensor) product = blurred(product, kNeighbourhood);
  return tensor;
}

/// Of the tensor's eigenvalues, less what noise has: 0 on average for that, 1 for stripes.
double coherence(double xx, double xy, double yy) {
  const double sum = xx + yy;
  if (!(sum > 0)) return 0;
  const double difference = (xx - yy) * (xx - yy) + 4 * xy * xy;
  return (difference / (sum * sum) - kCoherenceOfNoise) / (1 - kCoherenceOfNoise);
}

Plane lightness_difference(const Picture& shown, const Picture& reference) {
  const auto lightness = [](const std::array<float, 3>& pixel) {
    std::array<double, 3> linear{};
    for (std::size_t c = 0; c < 3; ++c) linear[c] = std::clamp(double{pixel[c]}, 0.0, 1.0);
    return lab_of_xyz(relative_xyz(linear))[0];
  };
  Plane error(shown.width, shown.height);
  for (std::size_t i = 0; i < error.values.size(); ++i) {
    error.values[i] = static_cast<float>(lightness(shown.pixels[i]) - lightness(reference.pixels[i]));
  }
  return error;
}

}  // namespace

Streaks streaks(const Plane& error) {
  double directed = 0;
  double all = 0;
  Plane level = error;
  for (unsigned i = 0; i < kBands && (i == 0 || std::min(level.width, level.height) >= kLeastEdge); ++i) {
    const Plane band = band_of(level);
    const std::array<Plane, 3> tensor = structure_tensor(band);
    const auto pixels = static_cast<double>(band.values.size());
    for (std::size_t p = 0; p < band.values.size(); ++p) {
      const double energy = double{band.values[p]} * double{band.values[p]} / pixels;
      all += energy;
      directed +=
          energy * coherence(double{tensor[0].values[p]}, double{tensor[1].values[p]}, double{tensor[2].values[p]});
    }
    level = halve(level);
  }
  directed = std::max(directed, 0.0);
  return {std::sqrt(directed), std::sqrt(all), all > 0 ? directed / all : 0};
}

Streaks streaks(const Picture& shown, const Picture& reference) {
  return streaks(lightness_difference(shown, reference));
}

}  // namespace torolux
