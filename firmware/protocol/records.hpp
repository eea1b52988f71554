// SPDX-License-Identifier: MIT
// Records: the state of one hemi-cube pixel's or one ray's light on its way. One record is one credit; a point, which
// becomes records elsewhere, is none (docs/credits.md).
// Lengths are in scene space normalised to the unit cube, flux in quanta (emitted flux * 2^-48), radiance in
// units of the scene's greatest emitted radiance.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/protocol/cells.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux::protocol {

inline constexpr std::uint32_t kNoPolygon = 0xFFFF'FFFFU;

/// Greatest number of subspaces of a segment that is told from others.
inline constexpr std::uint32_t kMostVisits = 63;

using Vec3f = std::array<float, 3>;
using Flux = std::array<std::int64_t, 3>;  ///< R, G, B [quanta]

enum class RecordKind : std::uint8_t {
  light,    ///< looks for the first polygon on its way
  deposit,  ///< flux on its way to the owner of the element that it met (radiosity stage)
  point,    ///< a point of a shot on its way to the PE that makes its records (radiosity stage): a PointRecord
  shade,    ///< has met a surface, and goes to its keeper (ray tracing stage)
  // Final gathering, at the end of the radiosity stage.
  gather_point,  ///< a point of an element on its way to the PE that makes its rays: a GatherPointRecord
  gather,        ///< looks from an element for the surface that lights it: a GatherRecord
  question,      ///< has met one, and goes to the owner of the element there: a GatherRecord
  answer,        ///< flux on its way back to the element that asked
};

constexpr bool is_of_gathering(RecordKind kind) {
  return kind >= RecordKind::gather_point && kind <= RecordKind::answer;
}

/// Bits of `flags`.
inline constexpr std::uint8_t kDirect = 1;    ///< straight from an emitter, no specular event yet
inline constexpr std::uint8_t kFirst = 2;     ///< still in the subspace where the path segment began
inline constexpr std::uint8_t kBackSide = 4;  ///< deposit: on the back of the element
inline constexpr std::uint8_t kShadow = 8;    ///< ray tracing: on its way from a diffuse surface to an emitter
inline constexpr std::uint8_t kGoesOn = 64;   ///< deposit: at the owner it goes on along its origin and direction
inline constexpr std::uint8_t kTurned =
    128;  ///< radiosity: by mirror, glass or lobe, where final gathering cannot look, or of a shot kept apart
/// light, without kFirst: the axis (0..2) of the face through which it entered its subspace. The interval of the
/// subspace begins at exactly that plane, so the next PE must know which one it was.
inline constexpr std::uint32_t kEntryAxisShift = 4;
inline constexpr std::uint8_t kEntryAxisMask = 0x30;

/// Of a point: 0: all pixels of its hemi-cube; 1..kPointParts: that part of them only.
inline constexpr std::uint32_t kPartShift = 4;
inline constexpr std::uint8_t kPartMask = 0xF0;
inline constexpr std::uint32_t kPointParts = 8;
/// Of a point: it is of sky and sun, through an opening (sky.hpp).
inline constexpr std::uint8_t kSky = 2;
/// Of a point of reflected light: final gathering leaves its shot's light to records (StageLayout::dense_shot).
inline constexpr std::uint8_t kApart = 4;
/// Of a point of emitted light: a measured lamp's (lamp.hpp); with kBackSide, of its back.
inline constexpr std::uint8_t kLamp = 8;

/// Radiosity stage: one hemi-cube pixel's flux.
struct RadiosityRecord {
  Vec3f origin;
  Vec3f direction;  ///< unit length
  Flux flux;
  std::uint32_t place;    ///< cell code of the subspace that it enters; deposit: of the owner's parts of patches
  std::uint32_t polygon;  ///< global number of the polygon that it left, or kNoPolygon; deposit: way_to_leaf
  std::uint32_t key;      ///< random numbers of this record: hash of (seed, patch, shot, point, pixel); kGoesOn: global
                          ///< number of the polygon that it leaves; answer: as GatherPointRecord::element
  RecordKind kind;
  std::uint8_t bounce;  ///< mirror, glass and glossy events so far
  std::uint8_t flags;
  std::uint8_t visited;  ///< subspaces of its present segment, with the last PE's; at most kMostVisits
};
static_assert(sizeof(RadiosityRecord) == 64);

/// Radiosity stage: one of a shot's points, with all that the PE that makes its records must know. It travels as a
/// RadiosityRecord does, and has its kind and flags where that has them.
struct PointRecord {
  Vec3f origin;
  Vec3f normal;  ///< unit length, of the side that shoots; kLamp: the lamp's number, 0 and 0, as it has a frame of its
                 ///< own
  Flux flux;  ///< to be divided among the hemi-cube's pixels; kSky: its part of what the opening would let in from all
              ///< directions were its cosine to each 1
  std::uint32_t place;    ///< cell code of the subspace that holds `origin`
  std::uint32_t polygon;  ///< global number of the polygon that its light leaves; kSky: number of the opening
  std::uint32_t key;      ///< hash of (seed, patch, shot)
  RecordKind kind;
  std::uint8_t number_low;  ///< of the point in its shot, 16 bits
  std::uint8_t flags;       ///< kDirect of emitted light; which of its pixels are meant (kPartMask)
  std::uint8_t number_high;
};
static_assert(sizeof(PointRecord) == sizeof(RadiosityRecord));
static_assert(offsetof(PointRecord, kind) == offsetof(RadiosityRecord, kind));
static_assert(offsetof(PointRecord, flags) == offsetof(RadiosityRecord, flags));

/// Of the point in its shot.
constexpr std::uint32_t point_number(const PointRecord& point) {
  return point.number_low | (std::uint32_t{point.number_high} << 8U);
}

/// Final gathering: a point of an element. It travels and waits as a PointRecord does.
struct GatherPointRecord {
  Vec3f origin;
  Vec3f normal;           ///< unit length, of the side that gathers
  std::uint32_t element;  ///< that gathers: of its owner's elements
  float area;             ///< of it, normalised; 0: no rays are to be made
  PeNumber home;          ///< its owner
  std::uint16_t unused[7];
  std::uint32_t place;  ///< as PointRecord, to the end
  std::uint32_t polygon;
  std::uint32_t key;
  RecordKind kind;
  std::uint8_t number_low;
  std::uint8_t flags;
  std::uint8_t number_high;
};
static_assert(sizeof(GatherPointRecord) == sizeof(PointRecord));
static_assert(offsetof(GatherPointRecord, place) == offsetof(PointRecord, place));

/// Final gathering: a ray against the light's way. It travels and is followed as a RadiosityRecord is.
struct GatherRecord {
  Vec3f origin;
  Vec3f direction;        ///< unit length
  Vec3f weight;           ///< of the flux per area that it finds: area of its element over the rays of the point
  std::uint32_t element;  ///< as GatherPointRecord
  PeNumber home;
  std::uint16_t unused[3];
  std::uint32_t place;  ///< as RadiosityRecord, to the end
  std::uint32_t polygon;
  std::uint32_t key;
  RecordKind kind;
  std::uint8_t bounce;
  std::uint8_t flags;
  std::uint8_t visited;
};
static_assert(sizeof(GatherRecord) == sizeof(RadiosityRecord));
static_assert(offsetof(GatherRecord, place) == offsetof(RadiosityRecord, place));

/// A second way of a ray (of refraction and reflection) that waits until the first has ended.
struct Branch {
  Vec3f origin;
  Vec3f direction;
  Vec3f weight;
  std::uint32_t place;  ///< cell code
  std::uint32_t polygon;
  std::uint32_t key;
  std::uint8_t bounce;
  std::uint8_t flags;  ///< kShadow: on its way to the sun; else 0
  std::uint8_t unused[2];
};
static_assert(sizeof(Branch) == 52);

inline constexpr std::uint32_t kMostBranches = 2;

/// Ray tracing stage: one sample's light path, followed from the eye.
struct RayRecord {
  Vec3f origin;
  Vec3f direction;      ///< unit length
  Vec3f weight;         ///< of what it sees, R G B, divided by the number of samples per pixel
  std::uint32_t place;  ///< cell code of the subspace that it enters
  std::uint32_t polygon;
  std::uint32_t key;     ///< random numbers: hash of (seed, pixel, sample, branches taken)
  std::uint32_t pixel;   ///< row * width + column
  std::uint32_t target;  ///< kShadow: global number of the emitter; `weight` is the light if nothing is before it.
                         ///< Kind shade: place of the surface that it has met among those that its keeper keeps
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
