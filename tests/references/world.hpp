// SPDX-License-Identifier: MIT
// A scene as the references see it: the product's Scene in; triangles, materials, emitters and closest hits (Embree)
// out.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "host_tools/scene/scene.hpp"
#include "tests/references/measured_light.hpp"
#include "tests/references/vectors.hpp"

namespace torolux::references {

enum class Model : std::uint8_t { diffuse, mirror, glass, pane, glossy };

struct Material {
  Model model = Model::diffuse;
  Colour diffuse = Colour::Zero();        ///< Kd, of diffuse and glossy
  std::uint32_t texture = kNoImage;       ///< that multiplies it
  Colour specular = Colour::Zero();       ///< Ks: of a mirror its reflectance, of glossy the lobe's at normal incidence
  double exponent = 0;                    ///< Ns of glossy, >= 0
  Colour transmittance = Colour::Ones();  ///< Tf of glass, at each crossing; of a pane, between its faces
  double refractive_index = 1.5;          ///< Ni of glass and pane, inside over outside
  Colour emission = Colour::Zero();       ///< Ke, radiance [W/(m^2 sr)]; of a lamp its flux over pi and area
  std::uint32_t lamp = kNoMeasuredLamp;   ///< that says how it depends on the direction
};

inline constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

struct Triangle {
  std::array<Vec, 3> corner;
  Vec normal;                                                          ///< unit, towards the front
  double area = 0;                                                     ///< [user units^2]
  std::optional<std::array<Vec, 3>> corner_normals;                    ///< unit
  std::optional<std::array<std::array<double, 2>, 3>> texture_points;  ///< u, v by corner
  std::uint32_t material = 0;
};

struct Hit {
  std::uint32_t triangle;
  double b1, b2;  ///< weights of corners 1 and 2
  bool front;     ///< met from the front
  Vec point;
};

/// A triangle that emits.
struct Emitter {
  std::uint32_t triangle;
  double power;  ///< radiance * area, mean of the channels
  bool around;   ///< shines from its back, too
  Vec centre;
};

/// One of them, chosen by chance.
struct EmitterChoice {
  std::uint32_t triangle;
  double density;  ///< of a point that is then taken evenly on it [1 / user units^2]; 0: no emitter sheds light there
};

/// The scene's, by number, as docs/scenes.md has them.
std::vector<Material> materials_of(const Scene& scene);

class World {
 public:
  /// two_sided_lights: emission from both sides.
  World(const Scene& scene, bool two_sided_lights) : World(scene, materials_of(scene), two_sided_lights) {}
  /// With other materials in place of the scene's, by number: for models that scene files do not name yet.
  World(const Scene& scene, std::vector<Material> materials, bool two_sided_lights);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const std::vector<Triangle>& triangles() const { return triangles_; }
  const Material& material(const Hit& hit) const { return materials_[triangles_[hit.triangle].material]; }

  /// Diffuse reflectance at a hit, the texture as its file has it, bilinear, in linear light.
  Colour diffuse_at(const Hit& hit) const;
  /// Radiance emitted at a hit towards `out`, unit length, on the side that was hit.
  Colour emission_at(const Hit& hit, const Vec& out) const;
  /// The same as a camera sees it: a lamp seen edge on counts as turned by 7 degrees.
  Colour emission_seen(const Hit& hit, const Vec& out) const;
  /// From its back as well as from its front.
  bool shines_around(std::uint32_t triangle) const;
  /// An emitter for the light at a point: near and strong ones more often, none whose back is towards it.
  /// uniform: in [0, 1).
  EmitterChoice pick_emitter(const Vec& point, double uniform) const;
  /// What pick_emitter(point) has for the triangle of a hit; 0 where it never takes that.
  double light_density(const Vec& point, const Hit& hit) const;
  const std::vector<Emitter>& emitters() const { return emitters_; }

  /// The hit at (b1, b2) of a triangle.
  Hit at(std::uint32_t triangle, double b1, double b2, bool front) const;
  /// Interpolated where the triangle has corner normals, else its own; unit.
  Vec shading_normal(const Hit& hit) const;

  /// leaving: a triangle that the ray starts on and cannot meet, or kNoTriangle. direction: unit.
  std::optional<Hit> closest(const Vec& origin, const Vec& direction, std::uint32_t leaving) const;
  /// Whether anything but these two triangles lies between two points.
  bool blocked(const Vec& from, const Vec& to, std::uint32_t leaving, std::uint32_t target) const;
  bool has_panes() const;
  /// Sky and sun, where the scene has them. Openings are where to look for it; its light
  /// comes from all around.
  const std::optional<Sky>& sky() const { return sky_; }
  /// Longest edge of the bounding box [user units].
  double size() const;
  /// The hit's point, moved off the surface towards `direction` by some rounding errors of the ray caster.
  Vec leave(const Hit& hit, const Vec& direction) const;

 private:
  struct RayCaster;
  void collect_emitters();
  Colour emission(const Hit& hit, const Vec& out, double least_cosine) const;
  double expected_light(const Emitter& emitter, const Vec& point) const;

  std::vector<Triangle> triangles_;
  std::vector<Material> materials_;
  std::vector<SceneTexture> textures_;
  std::vector<MeasuredLight> lamps_;
  std::vector<Emitter> emitters_;
  std::vector<std::uint32_t> emitter_of_;  // by triangle; kNoTriangle: none
  std::optional<Sky> sky_;
  bool two_sided_lights_;
  double offset_ = 0;  // of leave()
  std::unique_ptr<RayCaster> caster_;
};

}  // namespace torolux::references
