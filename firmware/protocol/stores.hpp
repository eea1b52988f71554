// SPDX-License-Identifier: MIT
// The stores: what the host lays out in a PE's local memory before a stage. All addresses are absolute.
// Scene space is normalised so that the longest edge of the object space is 1 and its lowest corner the origin.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/protocol/camera_ray.hpp"
#include "firmware/protocol/cells.hpp"
#include "firmware/protocol/flux.hpp"
#include "firmware/protocol/hemicube_bends.hpp"
#include "firmware/protocol/lamp.hpp"
#include "firmware/protocol/machine.hpp"
#include "firmware/protocol/polygon_boxes.hpp"
#include "firmware/protocol/records.hpp"
#include "firmware/protocol/sky.hpp"
#include "firmware/protocol/texture.hpp"

namespace torolux::protocol {

/// A subspace that a PE holds, its own or a copy.
struct Subspace {
  std::uint32_t first_polygon;  ///< index into the polygon list
  std::uint32_t polygon_count;  ///< entries there, groups' own included
};
static_assert(sizeof(Subspace) == 8);

/// Which sides of a polygon have elements (or, in the ray tracing stage, irradiance at corners).
inline constexpr std::uint8_t kFrontPresent = 1;
inline constexpr std::uint8_t kBackPresent = 2;

/// One per PE and polygon, shared by all its subspaces that the polygon touches.
struct Polygon {
  std::array<Vec3f, 3> corner;  ///< counter-clockwise seen from the front
  std::uint32_t number;         ///< global
  std::uint32_t surface;  ///< radiosity: index of its first PatchReference. Ray tracing: node (triangle_grid.hpp) whose
                          ///< leaves are indices of corner irradiances (the front's first, then the back's, as present)
  std::uint32_t normals;  ///< index of its first of three corner normals, or kNoPolygon: flat
  std::uint32_t texture_points;  ///< ray tracing, textured: index of its first of three texture points
  std::uint16_t material;
  std::uint8_t sides;        ///< kFrontPresent | kBackPresent
  std::uint8_t patch_level;  ///< it has part in 4^patch_level patches; radiosity only
  std::uint8_t unused[4];
};
static_assert(sizeof(Polygon) == 60);

enum class MaterialKind : std::uint32_t {
  diffuse,
  mirror,
  glass,
  glossy,  ///< diffuse, and a lobe about the mirror direction (firmware/pe/glossy.hpp)
  pane,    ///< thin glass: one polygon stands for both faces
};

/// Mirror, glass and pane: light is turned there or passes, and none stays. The others have elements.
constexpr bool is_specular(MaterialKind kind) {
  return kind == MaterialKind::mirror || kind == MaterialKind::glass || kind == MaterialKind::pane;
}

struct Material {
  MaterialKind kind;
  Vec3f diffuse;           ///< reflectance, 0..0.99; times the texture's colour where there is one
  Vec3f specular;          ///< mirror: reflectance. Glossy: Ks (n + 2) / (n + 1), n the lobe's exponent; at most 2
  Vec3f transmittance;     ///< glass: at each crossing; pane: on one way between its faces; 0..1
  float refractive_index;  ///< glass and pane: inside over outside
  Vec3f emission;          ///< radiance from the front, in units of the scene's greatest
  std::uint32_t emits_from_back;              ///< 0 or 1 (--two-sided-lights)
  float lobe_power;                           ///< glossy: 1 / (n + 1), above 0 and at most 1
  float lobe_chance;                          ///< glossy: the greatest of `specular`, at most 1
  std::uint32_t texture;                      ///< ray tracing: index, or kNoTexture
  std::array<Fraction, 3> specular_fraction;  ///< the same as `specular` (glossy: over `lobe_chance`, at most 2) and
                                              ///< `transmittance`: flux is exact
  std::array<Fraction, 3> transmittance_fraction;
  std::uint32_t lamp =
      kNoLamp;  ///< index: its emission depends on the direction (lamp.hpp); else the same to all sides
  std::uint32_t unused = 0;
};
static_assert(sizeof(Material) == 128);

// ---- Radiosity stage only ----

/// Of a level-patch_level triangle of a polygon: who owns the patch that it belongs to.
struct PatchReference {
  std::uint32_t part;  ///< place among the owner's parts
  PeNumber pe;
  std::uint16_t levels;  ///< at least the depth of the part's tree
};
static_assert(sizeof(PatchReference) == 8);

/// What of a polygon belongs to a patch, at its owner, and how it is cut into the patch's elements.
struct PatchPart {
  std::uint32_t patch;  ///< local
  std::uint32_t tree;   ///< node (triangle_grid.hpp) whose leaves are elements of the patch
};
static_assert(sizeof(PatchPart) == 8);

inline constexpr std::uint32_t kNoSide = 0xFFFF'FFFFU;

/// A patch at its owner. It has at least one facet and one element.
struct Patch {
  std::uint32_t number;       ///< global: ties are broken by it
  std::uint32_t first_facet;  ///< index into the facets
  std::uint32_t facets;
  std::uint32_t elements;                    ///< of each side
  std::array<std::uint32_t, 2> side;         ///< front, back: index into the patch sides, or kNoSide
  std::array<std::uint32_t, 3> reflectance;  ///< diffuse, a texture's mean over the patch; in units of 2^-32
};
static_assert(sizeof(Patch) == 36);

/// A flat part of one element, from which it shoots: the whole of it where a polygon is cut into elements, less where a
/// thing stands on it, one of many where an element is a cluster of small triangles. Facets of a patch follow its
/// elements' order, so that those near each other lie together.
struct Facet {
  std::uint32_t polygon;  ///< index into the PE's polygons
  std::uint32_t code;     ///< which triangle of its grid: location_code (triangle_grid.hpp)
  std::uint32_t element;  ///< of the patch
  float of_patch;         ///< its share of the patch's area, 0..1
  float of_element;       ///< its share of the element's area, 0..1; less: it would send where no light comes
  float lit_area;         ///< where light comes to it, normalised; kLeastLitArea..kMostLitArea
};
inline constexpr float kLeastLitArea = 0x1p-60F, kMostLitArea = 4.0F;
static_assert(sizeof(Facet) == 24);

/// One lit side of a patch.
struct PatchSide {
  Flux incident;                ///< all that has come, emitters' light included
  Flux shot;                    ///< the part of `incident` that has been turned into shots
  Flux emission;                ///< emitted flux that has not been shot
  std::uint32_t first_element;  ///< index into the elements; Patch::elements of them
  Vec3f shot_apart;             ///< the part of `shot` that final gathering is not to find once more, rounded
  Vec3f emits;                  ///< radiosity [quanta per normalised area]
  std::uint32_t unused;
};
static_assert(sizeof(PatchSide) == 104);

/// What of an element's flux has left it.
struct ElementShots {
  Vec3f shot;    ///< the part that has been turned into shots, rounded: where light leaves, not how much
  Vec3f unshot;  ///< what was not, at the last selection: while a round lasts, `flux` depends on the time
};

struct Element {
  Flux flux;   ///< incident, `apart` included
  Flux apart;  ///< the part of it that came as StageLayout::apart says
  union {
    ElementShots shots{};
    Flux gathered;  ///< from its final gathering on: what `points` have found together
  };
  float inverse_area;    ///< one over where light comes, normalised
  std::uint32_t points;  ///< that gather for it
};
static_assert(sizeof(Element) == 80);

/// Sums of one PE over the radiosity stage.
struct Tally {
  Flux absorbed_specular;     ///< lost at mirrors and glass
  Flux reflected_glossy;      ///< sent on by glossy lobes, of flux that elements have received
  Flux escaped;               ///< left the object space
  Flux cut_off;               ///< bounce limit
  Flux back_side;             ///< fell on a side that has no elements
  Flux sky_rest;              ///< of sky points' flux, less that of their records
  std::uint64_t rays;         ///< records created
  std::uint64_t gather_rays;  ///< of final gathering, not among them
};
static_assert(sizeof(Tally) == 160);

/// [n]: segments that ended at one PE, in a stage, after n subspaces of all PEs; kMostVisits: or more.
using Visits = std::array<std::uint32_t, kMostVisits + 1>;

/// Hemi-cube weights: exact delta form factors as fractions of 2^32. Half faces by symmetry, N = pixels across the top:
/// the top's quadrant [j][i], i, j in 0..N/2-1 counted from the axis outwards, then a side's half
/// [j][i]: i in 0..N/2-1 from its middle outwards, j in 0..N/2-1 from the surface up.
/// 4 * sum(top) + 8 * sum(side) == 2^32 exactly.
constexpr std::uint32_t hemicube_weights(std::uint32_t n) {
  return 2U * (n / 2U) * (n / 2U);
}
/// Pixels are numbered: top, row by row (N*N), then the four sides, row by row from the surface up (N * N/2 each).
constexpr std::uint32_t hemicube_pixels(std::uint32_t n) {
  return 3U * n * n;
}

// ---- Ray tracing stage only ----

/// Irradiance / pi at the corners of one side of an element, in units of the scene's greatest emitted radiance; times
/// reflectance = radiance.
struct CornerIrradiance {
  std::array<Vec3f, 3> irradiance_over_pi;  ///< by corner; signs mark concave edges (element_light.hpp)
};
static_assert(sizeof(CornerIrradiance) == 36);

/// Of a part of a polygon (patch level), what is seen on it, which this PE alone has (kKept).
struct KeptSurface {
  std::uint32_t polygon;  ///< local
  std::uint32_t node;     ///< of the part
};
static_assert(sizeof(KeptSurface) == 8);

/// Something that emits, for shadow rays. All PEs have all emitters, or none where no shadow rays are asked for.
struct Emitter {
  std::array<Vec3f, 3> corner;
  Vec3f emission;                ///< radiance from the front, in units of the scene's greatest
  float area_over_chance;        ///< area / (pi * the chance that it is chosen)
  std::uint32_t chosen_to;       ///< chosen by 32 random bits up to this, and beyond the one before; the last: all ones
  std::uint32_t polygon;         ///< global number; kSkyTarget: of sky and sun, whose emission is not used
  std::uint32_t both_sides;      ///< 0 or 1: emits from the back, too; of the sky: kSkyAround and the like
  std::uint32_t lamp = kNoLamp;  ///< index: it emits by this table alone, whatever `both_sides` is
};
static_assert(sizeof(Emitter) == 68);

// ---- Layout ----

struct Store {
  std::uint32_t address;
  std::uint32_t count;
};

enum class Stage : std::uint32_t { radiosity = 1, ray_tracing = 2 };

/// Bytes of one record slot.
constexpr std::uint32_t slot_bytes(Stage stage) {
  return stage == Stage::radiosity ? sizeof(RadiosityRecord) : sizeof(RayRecord);
}
/// The most records of a stage that one packet holds.
constexpr std::uint32_t records_per_packet(Stage stage) {
  const std::uint32_t fit = kMostPacketBytes / slot_bytes(stage);
  return fit < kMostRecordsPerPacket ? fit : kMostRecordsPerPacket;
}
/// Packets that a PE fills at a time, each for another PE: at most so many, a power of two.
inline constexpr std::uint32_t kMostOpenBatches = 64;
/// Slots of its own that a PE needs: created records wait in open batches, and one is in the making.
constexpr std::uint32_t own_slots(Stage stage, std::uint32_t open_batches) {
  return open_batches * (records_per_packet(stage) - 1U) + 1U;
}
inline constexpr std::uint32_t kMostOwnSlots = own_slots(Stage::radiosity, kMostOpenBatches);
static_assert(own_slots(Stage::ray_tracing, kMostOpenBatches) <= kMostOwnSlots);
/// Points that wait at a PE to be expanded, the current one included: the host deals no PE more.
inline constexpr std::uint32_t kPointPlaces = 4;
/// Tiles of the picture likewise.
inline constexpr std::uint32_t kTilePlaces = 2;

/// Path segments are counted in a byte of the record.
inline constexpr std::uint32_t kMostBounces = 255;
/// Hemi-cube pixels across the top; shot points are k * k, of emitted light more: one lamp may be all there is.
inline constexpr std::uint32_t kMostHemicubeSize = 256;
inline constexpr std::uint32_t kMostShotPoints = 64;
inline constexpr std::uint32_t kMostEmissionPoints = 256;
/// Of one side's final gathering: points are numbered in 16 bits.
inline constexpr std::uint32_t kMostGatherPoints = 65536;

/// What the host tells a PE before a stage. The PE checks it: stores inside its free memory, aligned to 8, apart from
/// each other.
struct StageLayout {
  Stage stage;
  std::uint32_t seed;
  std::array<std::uint32_t, 3> cells;  ///< Gx, Gy, Gz
  Vec3f cell_size;                     ///< plane i of an axis lies at float(i) * cell_size
  Store cell_words;                    ///< CellWord[cell_words(Gx * Gy * Gz)]
  Store cell_entries;                  ///< CellEntry[]: of the cells with a bit in the words, by index
  Store subspaces;                     ///< Subspace[]
  Store polygon_list;                  ///< ListedPolygon[]
  Store polygons;                      ///< Polygon[]
  Store materials;                     ///< Material[]
  Store normals;                       ///< Vec3f[]
  Store nodes;                         ///< uint32_t[]: trees over polygons, see triangle_grid.hpp
  Store record_slots;                  ///< RadiosityRecord[] or RayRecord[]: own_slots, then the NIU's
  std::uint32_t own_slots;
  std::uint32_t open_batches;                   ///< a power of two, 1..kMostOpenBatches
  std::uint32_t credits_kept;                   ///< that a PE keeps in hand while it has work
  std::uint32_t gather_cycles, gather_records;  ///< NiuWindow::gather
  std::uint32_t bounces;                        ///< path segments after which light is cut off
  Store sky;                                    ///< SkyEntry[kSkyEntries], or empty: no sky
  SkyFrame sky_frame;
  Store lamps;         ///< Lamp[]
  Store lamp_values;   ///< float[]: heights and intensities of their sides
  Store lamp_chances;  ///< uint32_t[]: radiosity stage only
  // Radiosity stage (counts 0 in the other).
  Store patch_references;         ///< PatchReference[]
  Store patch_parts;              ///< PatchPart[], of patches that this PE owns
  Store patches;                  ///< Patch[]
  Store patch_sides;              ///< PatchSide[]
  Store elements;                 ///< Element[]
  Store facets;                   ///< Facet[]
  Store hemicube;                 ///< HemicubeEntry[hemicube_weights(hemicube_size)]
  Store sky_openings;             ///< SkyOpening[]
  std::uint32_t hemicube_size;    ///< N, even
  std::uint32_t shot_points;      ///< k: k * k points at most per patch, reflected light
  std::uint32_t emission_points;  ///< k for emitted light
  float points_per_quantum;       ///< of reflected light, by the greatest channel of what is shot
  std::uint32_t apart;  ///< what Element::apart has, by records' flags. kDirect: straight from emitters, so that shadow
                        ///< rays can take its place. kTurned (or both): what final gathering does not find
  float dense_shot;  ///< final gathering: a very bright side's shot of more records per normalised area is kept apart,
                     ///< too: rays would find what is so small and bright by luck
  float mean_radiosity;  ///< of reflected light, about [quanta, R + G + B, per normalised area]: what is not brighter
                         ///< is never kept apart so
  std::uint32_t gathers_emission;  ///< 1: rays of final gathering find what emitters emit, too; 0: that comes otherwise
  // Ray tracing stage.
  Store irradiance;      ///< CornerIrradiance[]
  Store kept;            ///< KeptSurface[]
  Store textures;        ///< Texture[]
  Store texels;          ///< Texel[]
  Store texture_points;  ///< TexturePoint[]
  Store sample_places;   ///< SamplePlace[view.samples]; empty: the host makes the camera rays
  Store filter;          ///< float[2^view.filter_bits + 1], or empty likewise
  CameraView view;
  Store emitters;      ///< Emitter[]; not empty: `irradiance` has no light straight from emitters, shadow rays bring it
  float pixel_scale;   ///< quanta per unit of radiance
  float least_weight;  ///< a ray whose weights are all below dies
  std::uint32_t layers;  ///< planes of the frame buffer besides the colours, as bits (plane_bit)
};
static_assert(sizeof(StageLayout) == 516);

}  // namespace torolux::protocol
