// SPDX-License-Identifier: MIT
// Sky and sun: light that comes from far away, so that its radiance depends on the direction alone. Enters: a direction
// or random numbers; leaves: a place in the table, or a direction. By integers and single floats, no call of a library
// but sqrt: the host and every PE find the same to the last bit.
//
// The table divides the sphere by height z (the sine of the elevation) and by a turn about the vertical: bands of equal
// height have equal solid angles (Lambert's cylinder), and one of their borders is the horizon. The turn is counted
// along the square |x| + |y| = 1, not by an angle, which would need an arc tangent.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "firmware/protocol/records.hpp"
#include "firmware/protocol/vector_sums.hpp"

namespace torolux::protocol {

inline constexpr std::uint32_t kSkyBands = 32;    ///< of height, from -1 to 1; even: the horizon is a border
inline constexpr std::uint32_t kSkySectors = 64;  ///< of the turn, a multiple of 4
inline constexpr std::uint32_t kSkyCells = kSkyBands * kSkySectors;
static_assert(kSkyBands % 2U == 0 && kSkySectors % 4U == 0);
/// Entries of the table: band by band from below, each from the first sector on; the last one is the sun.
inline constexpr std::uint32_t kSkyEntries = kSkyCells + 1U;
/// `polygon` of the emitter that stands for sky and sun, and `target` of a shadow ray on its way there.
inline constexpr std::uint32_t kSkyTarget = kNoPolygon;
/// `both_sides` of such an emitter: all directions, without the sun's; the sun's, which has shadow rays of its own and
/// is the last emitter; those to a half of an opening, without the sun's.
inline constexpr std::uint32_t kSkyAround = 0, kSkySun = 2, kSkyThroughOpening = 3;

struct SkyEntry {
  Vec3f radiance;           ///< in units of the scene's greatest; of the sun its mean over the disc
  std::uint32_t chosen_to;  ///< chosen by 32 random bits up to this, and beyond the one before; the last: all ones
};
static_assert(sizeof(SkyEntry) == 16);

/// What all of the sky shares.
struct SkyFrame {
  Vec3f x, y, up;            ///< unit length, at right angles, right-handed; the turn begins at x and goes to y
  Vec3f sun;                 ///< unit length, towards the sun's middle
  Vec3f sun_x, sun_y;        ///< unit length, at right angles to it and each other
  float sun_tangent;         ///< of the disc's radius as seen; 0: no sun
  Vec3f inverse_irradiance;  ///< 1 / the radiance summed over all directions [1 / (unit of radiance x sr)]; 0: none
};
static_assert(sizeof(SkyFrame) == 88);

/// A parallelogram through which sky and sun come in: a face of the object space, or what the scene names.
struct SkyOpening {
  Vec3f corner, along, across;  ///< normalised scene space
  Vec3f inwards;                ///< unit length
};
static_assert(sizeof(SkyOpening) == 48);
inline constexpr std::uint32_t kMostSkyOpenings = 64;

/// The turn of a horizontal direction, 0..4; x, y: not both zero.
inline float sky_turn(float x, float y) {
  const float inverse = 1.0F / (std::fabs(x) + std::fabs(y));
  const float along = std::fabs(y) * inverse;  // of a quarter, from the x axis on
  if (x >= 0.0F) return y >= 0.0F ? along : 4.0F - along;
  return y >= 0.0F ? 2.0F - along : 2.0F + along;
}

/// A horizontal direction on the square |x| + |y| = 1, and how fast the angle grows with the turn there.
struct SkyHorizontal {
  float x, y;
  float angle_by_turn;  ///< 1..2
};
inline SkyHorizontal sky_horizontal(float turn) {
  const auto quarter = static_cast<std::uint32_t>(turn);
  const float along = turn - static_cast<float>(quarter);
  const float first = 1.0F - along;
  SkyHorizontal h{first, along, 1.0F / (first * first + along * along)};
  if (quarter == 1U) h = {-along, first, h.angle_by_turn};
  if (quarter == 2U) h = {-first, -along, h.angle_by_turn};
  if (quarter >= 3U) h = {along, -first, h.angle_by_turn};
  return h;
}

/// A direction drawn by chance, and what comes from there: its mean over all draws is the integral over the sphere.
struct SkySample {
  Vec3f direction;                ///< unit length, towards the sky
  Vec3f radiance_by_solid_angle;  ///< radiance over the density of directions [unit of radiance x sr]
};

/// Of the sun's disc, evenly.
/// u: of its area from the middle on, v: of the turn; 0..1. The turn's sine and cosine are those of an angle of at most
/// an eighth of it, by their series, turned by quarters.
inline Vec3f sun_direction(const SkyFrame& frame, float u, float v) {
  const float radius = std::sqrt(u) * frame.sun_tangent;
  // Each quarter from its middle on.
  const float turned = v * 4.0F;
  const auto quarter = static_cast<std::uint32_t>(turned);
  const float angle = ((turned - static_cast<float>(quarter)) - 0.5F) * 1.57079633F;
  const float q = angle * angle;
  const float sine = angle * (1.0F - q * (1.0F / 6.0F - q * (1.0F / 120.0F - q * (1.0F / 5040.0F))));
  const float cosine = 1.0F - q * (0.5F - q * (1.0F / 24.0F - q * (1.0F / 720.0F - q * (1.0F / 40320.0F))));
  float x = cosine;
  float y = sine;
  if (quarter == 1U) {
    x = -sine;
    y = cosine;
  } else if (quarter == 2U) {
    x = -cosine;
    y = -sine;
  } else if (quarter >= 3U) {
    x = sine;
    y = -cosine;
  }
  const Vec3f way = combined(frame.sun, 1.0F, frame.sun_x, x * radius, frame.sun_y, y * radius);
  const float inverse = 1.0F / std::sqrt(dot(way, way));
  return {way[0] * inverse, way[1] * inverse, way[2] * inverse};
}

/// word: chooses the entry and the height in it; v, 0..1: the turn. The table has kSkyEntries and chances.
inline SkySample sample_sky(const SkyFrame& frame, std::span<const SkyEntry> sky, std::uint32_t word, float v) {
  const auto chosen = std::lower_bound(sky.begin(), sky.end(), word,
                                       [](const SkyEntry& entry, std::uint32_t w) { return entry.chosen_to < w; });
  const auto number = static_cast<std::uint32_t>(chosen - sky.begin());
  const std::uint32_t first = number == 0 ? 0U : sky[number - 1U].chosen_to + 1U;
  const float words = static_cast<float>(chosen->chosen_to - first) + 1.0F;
  const float u = static_cast<float>(word - first) / words;
  const float inverse_chance = 0x1p32F / words;
  constexpr float kPi = 3.14159265F;
  constexpr float kBand = 2.0F / float{kSkyBands};
  constexpr float kSector = 4.0F / float{kSkySectors};
  if (number == kSkyCells) {
    const float solid_angle = (kPi * frame.sun_tangent) * frame.sun_tangent;
    const float weight = solid_angle * inverse_chance;
    return {sun_direction(frame, u, v),
            {chosen->radiance[0] * weight, chosen->radiance[1] * weight, chosen->radiance[2] * weight}};
  }
  const std::uint32_t band = number / kSkySectors;
  const float height = (static_cast<float>(band) + u) * kBand - 1.0F;
  const SkyHorizontal h = sky_horizontal((static_cast<float>(number - band * kSkySectors) + v) * kSector);
  const float rest = 1.0F - height * height;
  const float out = std::sqrt((rest > 0.0F ? rest : 0.0F) * h.angle_by_turn);
  const float weight = (kBand * kSector) * (h.angle_by_turn * inverse_chance);
  return {combined(frame.x, h.x * out, frame.y, h.y * out, frame.up, height),
          {chosen->radiance[0] * weight, chosen->radiance[1] * weight, chosen->radiance[2] * weight}};
}

/// Where a table's value between the middles of two steps lies: the lower step and how far on the way to the next.
struct SkyBetween {
  std::uint32_t lower, upper;
  float part;
};
/// at: in steps, 0..count. Rises and falls end at the borders `begin` and `end`.
inline SkyBetween sky_between(float at, std::uint32_t begin, std::uint32_t end) {
  const float from_middle = at - 0.5F;
  const float low = static_cast<float>(begin);
  if (!(from_middle > low)) return {begin, begin, 0.0F};
  const auto lower = static_cast<std::uint32_t>(from_middle);
  if (lower + 1U >= end) return {end - 1U, end - 1U, 0.0F};
  return {lower, lower + 1U, from_middle - static_cast<float>(lower)};
}

/// Radiance of the sky without its sun in a direction of unit length, between the middles of cells in proportion; not
/// across the horizon.
inline Vec3f radiance_without_sun(const SkyFrame& frame, std::span<const SkyEntry> sky, const Vec3f& direction) {
  const float height = dot(direction, frame.up);
  const float x = dot(direction, frame.x);
  const float y = dot(direction, frame.y);
  const bool vertical = x == 0.0F && y == 0.0F;
  const float turn = (vertical ? 0.0F : sky_turn(x, y)) * (float{kSkySectors} / 4.0F);
  constexpr std::uint32_t kHorizon = kSkyBands / 2U;
  const bool above = height >= 0.0F;
  const SkyBetween band =
      sky_between((height + 1.0F) * (float{kSkyBands} / 2.0F), above ? kHorizon : 0U, above ? kSkyBands : kHorizon);
  const float from_middle = turn < 0.5F ? turn + (float{kSkySectors} - 0.5F) : turn - 0.5F;  // the turn goes round
  const std::uint32_t left = std::min(static_cast<std::uint32_t>(from_middle), kSkySectors - 1U);
  const std::uint32_t right = left + 1U == kSkySectors ? 0U : left + 1U;
  const float across = from_middle - static_cast<float>(left);
  Vec3f radiance{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto at = [&](std::uint32_t row, std::uint32_t column) {
      return sky[row * kSkySectors + column].radiance[c];
    };
    const float low = at(band.lower, left) + (at(band.lower, right) - at(band.lower, left)) * across;
    const float high = at(band.upper, left) + (at(band.upper, right) - at(band.upper, left)) * across;
    radiance[c] = low + (high - low) * band.part;
  }
  return radiance;
}

/// With the sun.
inline Vec3f sky_radiance(const SkyFrame& frame, std::span<const SkyEntry> sky, const Vec3f& direction) {
  Vec3f radiance = radiance_without_sun(frame, sky, direction);
  const float towards = dot(direction, frame.sun);
  const float along_x = dot(direction, frame.sun_x);
  const float along_y = dot(direction, frame.sun_y);
  const float edge = frame.sun_tangent * towards;
  if (towards > 0.0F && along_x * along_x + along_y * along_y < edge * edge) {
    for (std::size_t c = 0; c < 3; ++c) radiance[c] += sky[kSkyCells].radiance[c];
  }
  return radiance;
}

}  // namespace torolux::protocol
