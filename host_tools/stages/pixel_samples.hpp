// SPDX-License-Identifier: MIT
// Where the samples of a pixel lie on the picture: drawn from the reconstruction filter around its middle, so that each
// weighs the same and falls on no other pixel (filter importance sampling: Ernst, Stamminger & Greiner 2006).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace torolux {

/// How what lies around a pixel's middle weighs in the pixel; the product of two such curves, across and down.
enum class PixelFilter : std::uint8_t {
  box,       ///< the pixel's square alone, all of it alike
  tent,      ///< falls in a straight line to zero at the middles of the next pixels
  gaussian,  ///< exp(-(r / 0.5)^2 / 2), r in pixels, cut off at 1.5
};

struct FilterName {
  std::string_view name;
  PixelFilter filter;
};
inline constexpr std::array<FilterName, 3> kPixelFilters{
    {{"box", PixelFilter::box}, {"tent", PixelFilter::tent}, {"gaussian", PixelFilter::gaussian}}};

std::string_view name_of(PixelFilter filter);
/// Nothing where there is none of this name.
std::optional<PixelFilter> filter_named(std::string_view name);

/// A place on the picture from a pixel's upper left corner, in pixels, x rightwards, y downwards.
struct PixelPlace {
  double x, y;
};

/// Of the pixel's square, each 0..1. Stratified in two ways: one sample in each cell of a grid of as equal sides as
/// divide their number, and one in each of `samples` rows and columns; jittered within (one sample: the pixel's
/// centre). key: of the sample.
PixelPlace pixel_place(std::uint32_t sample, std::uint32_t samples, std::uint32_t key);

/// Distance from the middle, in pixels, below which the part `u` (0..1) of the filter lies. Rises with u.
double filter_distance(PixelFilter filter, double u);

/// The places of all samples of all pixels. Each pixel has the same pattern, moved by a part of the pixel's square that
/// neighbours share out evenly (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018): were it
/// not moved, an edge along a row of pixels would be wrong by the same in all of them.
class PixelSamples {
 public:
  PixelSamples(PixelFilter filter, std::uint32_t samples, std::uint32_t seed);

  std::size_t table_entries() const { return distances_.size(); }
  std::uint32_t count() const { return static_cast<std::uint32_t>(uniform_.size()); }
  /// Some lie outside the pixel's square.
  PixelPlace place(std::uint32_t column, std::uint32_t row, std::uint32_t sample) const;

 private:
  double distance(double u) const;

  std::vector<PixelPlace> uniform_;  ///< by sample, 0..1
  std::vector<double> distances_;    ///< filter_distance at equal steps of u from 0 to 1
};

}  // namespace torolux
