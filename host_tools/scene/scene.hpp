// SPDX-License-Identifier: MIT
// A scene as the host tools hand it on: triangles, materials and a camera, checked, in the user's units.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "host_tools/settings/given_settings.hpp"

namespace torolux {

using Vec3d = std::array<double, 3>;

enum class SurfaceKind : std::uint8_t { diffuse, mirror, glass };

/// An image that multiplies a diffuse reflectance.
struct SceneTexture {
  std::string file;
  std::uint32_t width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 3>> texels;  ///< sRGB (IEC 61966-2-1); row by row, the lowest first
  bool clamped = false;                             ///< does not repeat: beyond its edges its outermost texels go on
};
inline constexpr std::uint32_t kNoImage = 0xFFFF'FFFFU;

inline constexpr std::uint32_t kNoMeasuredLamp = 0xFFFF'FFFFU;

struct SceneMaterial {
  std::string name;
  SurfaceKind kind = SurfaceKind::diffuse;
  Vec3d diffuse{0, 0, 0};   ///< Kd, reflectance, with `specular` 0..0.99 after checking; 0 for mirror and glass
  Vec3d specular{0, 0, 0};  ///< Ks of a mirror, reflectance, 0..0.99; of a diffuse surface: of its glossy lobe
  std::uint32_t texture = kNoImage;  ///< into Scene::textures; of a diffuse surface
  double exponent = 0;               ///< Ns, of the glossy lobe, >= 0
  Vec3d transmittance{1, 1, 1};      ///< Tf of glass, at each crossing, 0..1
  double refractive_index = 1.5;     ///< Ni of glass
  bool thin = false;                 ///< glass that is a pane of one sheet: light passes unbent, by both its faces
  bool thin_where_open = false;      ///< glass of which decide_panes is still to say where it is thin
  Vec3d emission{0, 0, 0};           ///< Ke, radiance [W/(m^2 sr)] from the front; of a measured lamp: its flux over
                                     ///< pi and the area of its opening
  std::uint32_t lamp = kNoMeasuredLamp;  ///< into Scene::lamps: how its emission depends on the direction

  bool operator==(const SceneMaterial&) const = default;
};

/// What stands for a material that a file does not give.
inline SceneMaterial white_material(const std::string& name) {
  SceneMaterial white;
  white.name = name;
  white.diffuse = {0.99, 0.99, 0.99};  // as near to 1 as light comes to an end at
  return white;
}

inline bool emits(const SceneMaterial& material) {
  return material.kind == SurfaceKind::diffuse &&
         std::ranges::any_of(material.emission, [](double e) { return e > 0; });
}

/// Diffuse, with a lobe about the mirror direction.
inline bool is_glossy(const SceneMaterial& material) {
  return material.kind == SurfaceKind::diffuse && material.specular != Vec3d{0, 0, 0};
}

struct SceneTriangle {
  std::array<std::uint32_t, 3> position;  ///< into Scene::positions; equal positions have one index
  std::array<std::uint32_t, 3> normal;  ///< into Scene::normals, or kNoNormal: flat. Not kept for what is only diffuse
  std::uint32_t material;
  std::uint32_t texture_points = kNoImage;  ///< textured: first of its three in Scene::texture_points
};
inline constexpr std::uint32_t kNoNormal = 0xFFFF'FFFFU;

struct Camera {
  Vec3d eye{0, 0, 0};
  Vec3d look_at{0, 0, -1};
  Vec3d up{0, 1, 0};
  double field_of_view_degrees = 40;  ///< vertical
  double aperture = 0;                ///< diameter of the lens [scene units]; 0: none, all is sharp
  /// Where it is sharp: distance from the eye along the view [scene units], or a point; absent: at look_at.
  std::optional<std::variant<double, Vec3d>> focus{};

  bool operator==(const Camera&) const = default;
};

/// Measured intensity by direction: gamma is the angle from the lamp's nadir, the turn goes around it.
struct LampWeb {
  std::vector<double> gamma;  ///< degrees, 0..180, rising, at least two; 90 among them where it lies in their range.
                              ///< Beyond them there is no light
  std::vector<double> turn;   ///< degrees, rising from 0 to 360, where all is as at 0; or 0 alone: the same all around
  std::vector<double> intensity;  ///< [W/sr], those of each turn together

  bool operator==(const LampWeb&) const = default;
};

/// How a measured lamp hangs. x, y and nadir are of unit length and at right angles; y may be mirrored. The opening is
/// flat, and its front looks along nadir.
struct SceneLamp {
  std::uint32_t web;            ///< into Scene::webs
  Vec3d x, y, nadir;            ///< the turn begins at x and goes to y
  std::array<double, 2> share;  ///< of its flux that leaves the front and the back; 1 together

  bool operator==(const SceneLamp&) const = default;
};

/// A parallelogram through which light comes in along `along` x `across`.
struct SkyQuad {
  Vec3d corner, along, across;
};

/// What shines from far away: its radiance depends on the direction alone.
struct Sky {
  Vec3d east{1, 0, 0}, north{0, 0, -1}, up{0, 1, 0};  ///< unit length, at right angles: east x north = up
  std::vector<Vec3d> radiance;    ///< by cell (firmware/protocol/sky.hpp), without the sun [W/(m^2 sr)]
  Vec3d sun{0, 1, 0};             ///< unit length, towards it
  Vec3d sun_irradiance{0, 0, 0};  ///< on a surface that faces it [W/m^2]
  std::vector<SkyQuad> openings;  ///< through which alone its light comes in; none: from all around
};

/// A value that is read only where nothing outweighs it.
struct PlacedText {
  std::string text;
  std::string place;  ///< FILE:LINE, for messages
};

/// Values that a scene.toml suggests for options the user did not give.
struct SceneDefaults {
  GivenSettings given;
  std::optional<PlacedText> subspaces, allocation, quality;
};

struct Scene {
  std::string name;  ///< of the folder or file, for output names
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;                         ///< unit
  std::vector<std::array<double, 2>> texture_points;  ///< u rightwards, v upwards; textures repeat with period 1
  std::vector<SceneTriangle> triangles;
  std::vector<SceneMaterial> materials;
  std::vector<SceneTexture> textures;
  std::vector<LampWeb> webs;
  std::vector<SceneLamp> lamps;
  std::optional<Sky> sky;
  std::optional<Camera> camera;
  SceneDefaults defaults;
  std::vector<std::string> warnings;
};

/// Flux that leaves one side (0 front, 1 back) over pi and area [W/(m^2 sr)]: radiance, but of a measured lamp.
inline Vec3d emission_of(const Scene& scene, const SceneMaterial& material, std::size_t side, bool two_sided_lights) {
  if (!emits(material)) return {0, 0, 0};
  if (material.lamp == kNoMeasuredLamp) return side == 0 || two_sided_lights ? material.emission : Vec3d{0, 0, 0};
  Vec3d emission = material.emission;
  for (double& channel : emission) channel *= scene.lamps[material.lamp].share[side];
  return emission;
}
inline bool emits_from(const Scene& scene, const SceneMaterial& material, std::size_t side, bool two_sided_lights) {
  return emission_of(scene, material, side, two_sided_lights) != Vec3d{0, 0, 0};
}

}  // namespace torolux
