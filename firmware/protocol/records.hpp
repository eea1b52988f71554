// SPDX-License-Identifier: MIT
// Records: the state of one hemi-cube pixel's or one ray's light on its way. One record is one credit.
// Lengths are in scene space normalised to the unit cube, flux in quanta (emitted flux * 2^-48), radiance in
// units of the scene's greatest emitted radiance.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/protocol/machine.hpp"

namespace torolux::protocol {

inline constexpr std::uint32_t kNoPolygon = 0xFFFF'FFFFU;

/// Greatest number of subspaces of a segment that is told from others.
inline constexpr std::uint32_t kMostVisits = 63;

using Vec3f = std::array<float, 3>;
using Flux = std::array<std::int64_t, 3>;  ///< R, G, B [quanta]

enum class RecordKind : std::uint8_t {
  light,    ///< looks for the first polygon on its way
  seek,     ///< light or ray that walks to the subspace of its origin first, touching nothing on the way
  deposit,  ///< flux on its way to the owner of the element that it met (radiosity stage)
  branch,   ///< a ray whose current path has ended, on its way to where its waiting branch begins (ray tracing stage)
};

/// Bits of `flags`.
inline constexpr std::uint8_t kDirect = 1;    ///< straight from an emitter, no specular event yet
inline constexpr std::uint8_t kFirst = 2;     ///< still in the subspace where the path segment began
inline constexpr std::uint8_t kBackSide = 4;  ///< deposit: on the back of the element
inline constexpr std::uint8_t kShadow = 8;    ///< ray tracing: on its way from a diffuse surface to an emitter
inline constexpr std::uint8_t kGoesOn = 64;   ///< deposit: at the owner it goes on along its origin and direction
/// light, without kFirst: the axis (0..2) of the face through which it entered its subspace. The interval of the
/// subspace begins at exactly that plane, so the next PE must know which one it was.
inline constexpr std::uint32_t kEntryAxisShift = 4;
inline constexpr std::uint8_t kEntryAxisMask = 0x30;

/// Radiosity stage: one hemi-cube pixel's flux.
struct RadiosityRecord {
  Vec3f origin;
  Vec3f direction;  ///< unit length
  Flux flux;
  std::uint32_t subspace;  ///< local number at the PE that receives it; deposit: local patch number
  std::uint32_t polygon;   ///< global number of the polygon that it left, or kNoPolygon; deposit: element of the patch
  std::uint32_t key;  ///< random numbers of this record: hash of (seed, patch, shot, point, pixel); kGoesOn: global
                      ///< number of the polygon that it leaves
  RecordKind kind;
  std::uint8_t bounce;  ///< mirror, glass and glossy events so far
  std::uint8_t flags;
  std::uint8_t visited;  ///< subspaces of its present segment, with the last PE's; at most kMostVisits
};
static_assert(sizeof(RadiosityRecord) == 64);

/// A second way of a ray (of refraction and reflection) that waits until the first has ended.
struct Branch {
  Vec3f origin;
  Vec3f direction;
  Vec3f weight;
  std::uint32_t subspace;  ///< local number at `pe`
  std::uint32_t polygon;
  std::uint32_t key;
  std::uint16_t pe;
  std::uint8_t bounce;
  std::uint8_t flags;
};
static_assert(sizeof(Branch) == 52);

inline constexpr std::uint32_t kMostBranches = 2;

/// Ray tracing stage: one sample's light path, followed from the eye.
struct RayRecord {
  Vec3f origin;
  Vec3f direction;  ///< unit length
  Vec3f weight;     ///< of what it sees, R G B, divided by the number of samples per pixel
  std::uint32_t subspace;
  std::uint32_t polygon;
  std::uint32_t key;     ///< random numbers: hash of (seed, pixel, sample, branches taken)
  std::uint32_t pixel;   ///< row * width + column
  std::uint32_t target;  ///< kShadow: global number of the emitter; `weight` is the light if nothing is before it
  RecordKind kind;
  std::uint8_t bounce;  ///< segments ended so far
  std::uint8_t flags;
  std::uint8_t waiting;  ///< branches in use, 0..kMostBranches
  std::array<Branch, kMostBranches> branches;
  std::uint16_t sample;   ///< of the pixel, counted from 0: for random numbers that keep apart (stratified.hpp)
  std::uint16_t visited;  ///< as in RadiosityRecord
};
static_assert(sizeof(RayRecord) == 168);

}  // namespace torolux::protocol
