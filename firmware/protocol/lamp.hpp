// SPDX-License-Identifier: MIT
// Measured lamps: emitters whose light depends on the direction. Enters: a direction or random numbers; leaves: an
// intensity, or a direction. By integers and single floats, no call of a library but sqrt: the host and every PE find
// the same to the last bit.
//
// A lamp's opening is a flat sheet. Each of its sides has a table: bands of the cosine to the side's normal, which need
// not be equally wide (a spot's light is all in a few degrees), by equal sectors of the turn about it. Intensities
// stand at the corners; in between they are bilinear, and so are drawn exactly.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "firmware/protocol/records.hpp"
#include "firmware/protocol/sine_cosine.hpp"
#include "firmware/protocol/vector_sums.hpp"

namespace torolux::protocol {

inline constexpr std::uint32_t kNoLamp = 0xFFFF'FFFFU;
inline constexpr std::uint32_t kMostLampBands = 48;
inline constexpr std::uint32_t kMostLampSectors = 72;

/// Of one side of the opening. Indices into the lamps' values and chances.
struct LampSide {
  std::uint32_t bands;    ///< from the normal to the opening's plane; 0: no light on this side
  std::uint32_t sectors;  ///< of the turn; 1: the same all around
  std::uint32_t heights;  ///< first of bands + 1 cosines to the normal, falling from 1 to 0
  std::uint32_t values;   ///< first of (bands + 1) * sectors intensities, those of each height together, in units of
                          ///< the material's emission times the opening's area; over both sides their integral is pi
  std::uint32_t chances;  ///< radiosity: first of bands * sectors; a cell is chosen by 32 random bits up to this, and
                          ///< beyond the one before; the last: all ones
};
static_assert(sizeof(LampSide) == 20);

struct Lamp {
  Vec3f x, y;                    ///< unit length; the turn begins at x and goes to y
  Vec3f nadir;                   ///< unit length, at right angles to them: normal of the opening's front
  std::array<LampSide, 2> side;  ///< front, back
};
static_assert(sizeof(Lamp) == 76);

/// Whose light a point of a shot is.
struct LampPoint {
  std::uint32_t lamp;
  std::uint32_t side;  ///< 0 front, 1 back
};

/// What is seen of a lamp has the radiance intensity / (area x cosine), where the cosine counts as no less than this
/// (83 degrees): a sheet seen edge on has no area, and yet a lamp's rim shines sideways.
inline constexpr float kLeastLampCosine = 0.125F;

/// Where a direction lies in a side's table.
struct LampPlace {
  std::uint32_t band;         ///< between heights band and band + 1
  float down;                 ///< how far, 0..1
  std::uint32_t left, right;  ///< sectors' borders on both sides
  float across;               ///< how far from the left one, 0..1
};

/// Share of the whole turn that a direction has from x on, 0..1 (M. Abramowitz, I. Stegun, Handbook of Mathematical
/// Functions, 4.4.49: errors below 2e-6 of a turn). Not both zero.
inline float turn_of(float x, float y) {
  const float along = std::fabs(x);
  const float aside = std::fabs(y);
  const bool steep = aside > along;
  const float t = steep ? along / aside : aside / along;
  const float q = t * t;
  const float angle =
      t * (0.9998660F + q * (-0.3302995F + q * (0.1801410F + q * (-0.0851330F + q * 0.0208351F)))) * 0.159154943F;
  const float quarter = steep ? 0.25F - angle : angle;
  const float half = x < 0.0F ? 0.5F - quarter : quarter;
  return y < 0.0F ? 1.0F - half : half;
}

/// height: cosine to the side's normal, above 0; x, y: the direction's parts along the lamp's.
inline LampPlace lamp_place(const LampSide& side, std::span<const float> values, float height, float x, float y) {
  const auto heights = values.subspan(side.heights, side.bands + 1U);
  const auto below = std::lower_bound(heights.begin() + 1, heights.end() - 1, height,
                                      [](float at, float wanted) { return at > wanted; });
  LampPlace place{};
  place.band = static_cast<std::uint32_t>(below - heights.begin()) - 1U;
  const float upper = heights[place.band];
  place.down = std::clamp((upper - height) / (upper - *below), 0.0F, 1.0F);
  if (side.sectors == 1U || (x == 0.0F && y == 0.0F)) return place;
  const float at = turn_of(x, y) * static_cast<float>(side.sectors);
  place.left = std::min(static_cast<std::uint32_t>(at), side.sectors - 1U);
  place.right = place.left + 1U == side.sectors ? 0U : place.left + 1U;
  place.across = std::min(at - static_cast<float>(place.left), 1.0F);
  return place;
}

/// In units of emission times area. direction: unit length, away from the lamp; side: 0 front, 1 back. 0: none goes
/// there.
inline float lamp_intensity(const Lamp& lamp, std::uint32_t side, std::span<const float> values,
                            const Vec3f& direction) {
  const LampSide& table = lamp.side[side];
  const float along = dot(direction, lamp.nadir);
  const float height = side == 0 ? along : -along;
  if (table.bands == 0 || !(height > 0.0F)) return 0.0F;
  const LampPlace place = lamp_place(table, values, height, dot(direction, lamp.x), dot(direction, lamp.y));
  const auto at = [&](std::uint32_t row, std::uint32_t column) {
    return values[table.values + row * table.sectors + column];
  };
  const auto row = [&](std::uint32_t number) {
    const float left = at(number, place.left);
    return left + (at(number, place.right) - left) * place.across;
  };
  const float upper = row(place.band);
  return upper + (row(place.band + 1U) - upper) * place.down;
}

/// Drawn by a density that goes from `a` to `b`, neither below 0, in a straight line over 0..1.
inline float by_slope(float u, float a, float b) {
  const float sum = a + std::sqrt(a * a + u * (b * b - a * a));
  if (!(sum > 0.0F)) return u;
  const float at = u * (a + b) / sum;
  return at < 1.0F ? at : 1.0F;
}

/// A direction of unit length by the side's intensity. word: chooses the cell and the height in it; v, 0..1: the turn.
/// The side has bands.
inline Vec3f sample_lamp(const Lamp& lamp, std::uint32_t side, std::span<const float> values,
                         std::span<const std::uint32_t> all_chances, std::uint32_t word, float v) {
  const LampSide& table = lamp.side[side];
  const auto chances = all_chances.subspan(table.chances, table.bands * table.sectors);
  const auto chosen = std::lower_bound(chances.begin(), chances.end(), word);
  const auto number = static_cast<std::uint32_t>(chosen - chances.begin());
  const std::uint32_t first = number == 0 ? 0U : chances[number - 1U] + 1U;
  const float u = static_cast<float>(word - first) / (static_cast<float>(*chosen - first) + 1.0F);
  const std::uint32_t band = number / table.sectors;
  const std::uint32_t left = number - band * table.sectors;
  const std::uint32_t right = left + 1U == table.sectors ? 0U : left + 1U;
  const auto at = [&](std::uint32_t row, std::uint32_t column) {
    return values[table.values + row * table.sectors + column];
  };
  const float down = by_slope(u, at(band, left) + at(band, right), at(band + 1U, left) + at(band + 1U, right));
  const float on_left = at(band, left) + (at(band + 1U, left) - at(band, left)) * down;
  const float on_right = at(band, right) + (at(band + 1U, right) - at(band, right)) * down;
  const float turn =
      (static_cast<float>(left) + by_slope(v, on_left, on_right)) * (4.0F / static_cast<float>(table.sectors));
  const float upper = values[table.heights + band];
  const float height = upper + (values[table.heights + band + 1U] - upper) * down;
  const float rest = 1.0F - height * height;
  const float out = std::sqrt(rest > 0.0F ? rest : 0.0F);
  // Each quarter of the turn from its middle on.
  const auto quarter = static_cast<std::uint32_t>(turn);
  const SineCosine by = sine_cosine((turn - static_cast<float>(quarter) - 0.5F) * 1.57079633F);
  constexpr float kHalfRoot = 0.707106781F;
  const float cosine = (by.cosine - by.sine) * kHalfRoot;
  const float sine = (by.cosine + by.sine) * kHalfRoot;
  const std::array<float, 4> along{cosine, -sine, -cosine, sine};
  const std::array<float, 4> aside{sine, cosine, -sine, -cosine};
  return combined(lamp.x, along[quarter & 3U] * out, lamp.y, aside[quarter & 3U] * out, lamp.nadir,
                  side == 0 ? height : -height);
}

}  // namespace torolux::protocol
