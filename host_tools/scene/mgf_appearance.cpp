// SPDX-License-Identifier: MIT
// From MGF's shares of light to the machine's materials.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host_tools/scene/mgf_materials.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// As MGF's own translators have it: less shines through than anybody would see.
constexpr double kSeenThrough = 0.01;
/// A mirror beside a diffuse part is a lobe as narrow as this: half a degree.
constexpr double kMostExponent = 10'000;

class Appearance {
 public:
  Appearance(const std::string& name, const MgfMaterial& from, Notices& notices) : from_(from), notices_(notices) {
    result_.material.name = name;
    result_.place = from.place;
    result_.defined = from.defined;
    result_.faults = from.faults;
  }

  ImportedMaterial run() {
    if (from_.diffuse_through.amount > kSeenThrough)
      notices_.note("diffuse transmittance (td) is not rendered", from_.place);
    const bool clear = from_.specular_through.amount > kSeenThrough;
    if (clear && from_.emitted.amount == 0 && from_.specular_through.amount >= from_.diffuse.amount) {
      transparent();
    } else {
      if (clear)
        notices_.note("specular transmittance (ts) beside more diffuse reflectance, or light, is not rendered",
                      from_.place);
      opaque();
    }
    return std::move(result_);
  }

 private:
  Vec3d colour_of(const MgfPortion& portion) {
    const LinearColour colour = linear_colour(portion.colour, portion.amount);
    if (colour.clipped && portion.amount > 0)
      notices_.note("a colour beyond what red, green and blue of a screen can mix is replaced by the nearest",
                    from_.place);
    return colour.rgb;
  }

  void opaque() {
    SceneMaterial& material = result_.material;
    material.diffuse = colour_of(from_.diffuse);
    // Emitted power leaves evenly into a half space: radiance is exitance over pi.
    material.emission = vec::scale(colour_of(from_.emitted), 1 / (std::numbers::pi * kLumenPerWatt));
    if (from_.emitted.amount > 0 && !from_.one_sided)
      notices_.note("a surface of two sides emits from its front alone; --two-sided-lights: from both", from_.place);
    if (from_.specular.amount == 0) return;
    material.specular = colour_of(from_.specular);
    const double roughness = from_.specular.roughness;
    if (roughness == 0 && from_.diffuse.amount == 0 && from_.emitted.amount == 0) {
      material.kind = SurfaceKind::mirror;
    } else {
      // Facets whose slopes are exp(-tan^2 d / roughness^2) turn light by 2 d: cos^n (2 d) falls as fast for this n.
      material.exponent = 1 / std::max(2 * roughness * roughness, 1 / kMostExponent);
    }
  }

  void transparent() {
    SceneMaterial& material = result_.material;
    material.kind = SurfaceKind::glass;
    if (from_.diffuse.amount > kSeenThrough)
      notices_.note("the diffuse part of glass (rd) is not rendered", from_.place);
    if (from_.specular_through.roughness > 0)
      notices_.note("roughness of glass (ts) is not rendered: it is clear", from_.place);
    const bool given = from_.index != 1 && from_.index_imaginary == 0;
    material.thin = !(given && from_.one_sided);
    material.refractive_index = std::clamp(given ? from_.index : index_for_shares(), 0.2, 5.0);
    if (material.refractive_index != from_.index && given)
      notices_.note("an index of refraction (ir) beyond 0.2 to 5 is set to the nearest", from_.place);
    set_transmittance(material);
    if (material.thin) return;
    notices_.note("solid glass absorbs as if it were 5 mm thick (to which ts applies), whatever its size", from_.place);
    for (double& channel : material.transmittance) channel = std::sqrt(channel);  // once at each of two crossings
  }

  /// Of one face at right angles: Fresnel.
  static double one_face(double index) { return (index - 1) * (index - 1) / ((index + 1) * (index + 1)); }

  /// What is left on one way between two faces that reflect `face` each, where `through` passes both:
  /// docs/materials.md, Panes, solved for t.
  static double one_way(double face, double through) {
    const double twice = (1 - face) * (1 - face);
    return std::min(1.0, 2 * through / (twice + std::sqrt(twice * twice + 4 * through * through * face * face)));
  }

  /// Of both faces, with all that goes to and fro between them.
  static double reflected(double face, double through) { return face * (1 + one_way(face, through) * through); }

  /// The index of a pane that reflects rs and lets ts pass.
  double index_for_shares() const {
    double low = 0;
    double high = from_.specular.amount;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (reflected(middle, from_.specular_through.amount) < from_.specular.amount ? low : high) = middle;
    }
    const double root = std::sqrt(high);
    return root < 1 ? (1 + root) / (1 - root) : 5;
  }

  void set_transmittance(SceneMaterial& material) {
    const double face = one_face(material.refractive_index);
    if (std::abs(reflected(face, from_.specular_through.amount) - from_.specular.amount) > 0.02)
      notices_.note("glass reflects as its index of refraction (ir) has it, not as rs", from_.place);
    const Vec3d through = colour_of(from_.specular_through);
    for (std::size_t c = 0; c < 3; ++c) material.transmittance[c] = one_way(face, through[c]);
  }

  const MgfMaterial& from_;
  Notices& notices_;
  ImportedMaterial result_{};
};

}  // namespace

ImportedMaterial imported_material(const std::string& name, const MgfMaterial& material, Notices& notices) {
  return Appearance(name, material, notices).run();
}

}  // namespace torolux
