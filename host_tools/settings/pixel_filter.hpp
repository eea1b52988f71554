// SPDX-License-Identifier: MIT
// The reconstruction filters of a pixel, by name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

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

constexpr std::string_view name_of(PixelFilter filter) {
  return kPixelFilters[static_cast<std::size_t>(filter)].name;
}
/// Nothing where there is none of this name.
constexpr std::optional<PixelFilter> filter_named(std::string_view name) {
  for (const FilterName& known : kPixelFilters) {
    if (known.name == name) return known.filter;
  }
  return std::nullopt;
}

}  // namespace torolux
