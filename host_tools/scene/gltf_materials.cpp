// SPDX-License-Identifier: MIT
// Maps the metallic-roughness model and its extensions to what light does here.
#include "host_tools/scene/gltf_materials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "host_tools/scene/rough_surface.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

constexpr double kMost = kMostCoordinate;

constexpr std::array<std::string_view, 9> kRead{"KHR_materials_emissive_strength",
                                                "KHR_materials_ior",
                                                "KHR_materials_pbrSpecularGlossiness",
                                                "KHR_materials_specular",
                                                "KHR_materials_transmission",
                                                "KHR_materials_unlit",
                                                "KHR_materials_volume",
                                                "KHR_texture_transform",
                                                "KHR_materials_dispersion"};

/// Reads one material.
class Reader {
 public:
  Reader(const GltfObject& material, std::size_t number, GltfTextures& textures, GltfUnits units, Notices& notices)
      : object_(material), textures_(textures), units_(units), notices_(notices) {
    result_.material.place = material.place();
    result_.material.material.name = material.text("name").value_or("");
    if (result_.material.material.name.empty()) result_.material.material.name = "material " + std::to_string(number);
  }

  GltfMaterial read() {
    read_model();
    read_emission();
    SceneMaterial& material = result_.material.material;
    set_surface(surface_, emits(), material);
    read_alpha();
    read_transmission();
    if (material.kind != SurfaceKind::diffuse || vec::largest(material.diffuse) == 0) drop_texture();
    tell_the_rest();
    return std::move(result_);
  }

 private:
  bool emits() const { return vec::largest(result_.material.material.emission) > 0; }
  Place place() const { return object_.place(); }

  /// Of values for which a surface has one for all of it.
  std::optional<MeanTexel> mean(const std::optional<GltfObject>& holder, std::string_view key) {
    const auto info = holder ? holder->object(key) : std::nullopt;
    if (!info) return std::nullopt;
    notices_.note("a texture of another thing than the colour is used by its mean value", place(), std::string(key));
    return textures_.mean(*info, place());
  }

  void read_base(const std::optional<GltfObject>& holder, std::string_view factor, std::string_view texture) {
    if (!holder) return;
    if (const auto given = holder->numbers(factor, 4)) {
      for (const double one : *given)
        if (one < 0) refuse(place(), "'" + std::string(factor) + "' is below zero");
      surface_.colour = {(*given)[0], (*given)[1], (*given)[2]};
      alpha_ = (*given)[3];
    }
    if (const auto info = holder->object(texture)) {
      base_texture_ = *info;
      result_.material.texture = textures_.use(*info, place(), result_.mapping);
    }
  }

  void read_model() {
    if (const auto gloss = object_.extension("KHR_materials_pbrSpecularGlossiness")) return read_glossiness(*gloss);
    const auto model = object_.object("pbrMetallicRoughness");
    surface_ = {{1, 1, 1}, 1, {}, 1, {}};
    read_base(model, "baseColorFactor", "baseColorTexture");
    if (model) {
      surface_.metallic = model->number("metallicFactor", 0, 1).value_or(1);
      surface_.roughness = model->number("roughnessFactor", 0, 1).value_or(1);
    }
    if (const auto texel = mean(model, "metallicRoughnessTexture")) {
      surface_.metallic *= texel->raw[2];
      surface_.roughness *= texel->raw[1];
    }
    read_reflection();
    surface_.metal_colour = surface_.colour;
    const bool lobe = surface_.metallic > 0 && surface_.roughness < kWideMetal;
    if (lobe && base_texture_) {
      notices_.note("the colour of a metal that shines is the mean of its texture", place());
      if (const auto texel = textures_.mean(*base_texture_, place()))
        surface_.metal_colour = vec::times(surface_.colour, texel->linear);
    }
    if (object_.extension("KHR_materials_unlit")) {
      notices_.note("a material without light of its own or others' (unlit) is read as diffuse", place());
      surface_.metallic = 0;
      surface_.roughness = 1;
    }
  }

  /// Of what is no metal: by Fresnel at normal incidence, and KHR_materials_specular.
  void read_reflection() {
    if (const auto ior = object_.extension("KHR_materials_ior")) index_ = ior->number("ior", 0, 100).value_or(1.5);
    double at_normal = std::pow((index_ - 1) / (index_ + 1), 2);
    Vec3d tint{1, 1, 1};
    if (const auto specular = object_.extension("KHR_materials_specular")) {
      at_normal *= specular->number("specularFactor", 0, 1).value_or(1);
      tint = specular->colour("specularColorFactor").value_or(tint);
    }
    for (std::size_t c = 0; c < 3; ++c) surface_.reflection[c] = std::min(at_normal * tint[c], 1.0);
  }

  void read_glossiness(const GltfObject& gloss) {
    surface_ = {{1, 1, 1}, 0, {1, 1, 1}, 0, {}};
    read_base(gloss, "diffuseFactor", "diffuseTexture");
    surface_.reflection = gloss.colour("specularFactor").value_or(surface_.reflection);
    double glossiness = gloss.number("glossinessFactor", 0, 1).value_or(1);
    if (gloss.has("specularGlossinessTexture"))
      notices_.note("a texture of specular colour and glossiness is not used", place());
    for (double& one : surface_.reflection) one = std::min(one, 1.0);
    surface_.roughness = 1 - glossiness;
  }

  void read_emission() {
    Vec3d& emission = result_.material.material.emission;
    emission = object_.colour("emissiveFactor").value_or(Vec3d{0, 0, 0});
    double strength = 1;
    if (const auto given = object_.extension("KHR_materials_emissive_strength"))
      strength = given->number("emissiveStrength", 0, kMost).value_or(1);
    if (!emits()) return;
    if (const auto texel = mean(object_, "emissiveTexture")) emission = vec::times(emission, texel->linear);
    emission = vec::scale(emission, strength * radiance_per_luminance(units_));
    for (const double one : emission)
      if (!(one <= kMost)) refuse(place(), "emits more than 1e15");
    if (object_.flag("doubleSided"))
      notices_.note("a double-sided surface emits from its front; --two-sided-lights has both sides emit", place());
  }

  void read_alpha() {
    const std::string mode = object_.text("alphaMode").value_or("OPAQUE");
    const double cutoff = object_.number("alphaCutoff", 0, kMost).value_or(0.5);
    TextureUse& texture = result_.material.texture;
    texture.cutoff = 0;
    if (mode == "MASK") {
      result_.invisible = alpha_ < cutoff;
      if (alpha_ > 0) texture.cutoff = std::min(cutoff / alpha_, 1.0);
    } else if (mode == "BLEND") {
      if (alpha_ < 0.5 && !emits()) return read_film();
      notices_.note("half transparency (alphaMode BLEND) is not rendered: what has alpha of one half and more is there",
                    place());
      result_.invisible = alpha_ < 0.5;
      if (alpha_ > 0) texture.cutoff = std::min(0.5 / alpha_, 1.0);
    } else if (mode != "OPAQUE") {
      refuse(place(), "'alphaMode' is " + in_quotes(mode) + "; expected OPAQUE, MASK or BLEND");
    }
  }

  /// Nothing shows its colours; what it cuts out is cut out all the same.
  void drop_texture() {
    if (result_.material.texture.cutoff > 0) result_.material.opacity = result_.material.texture;
    result_.material.opacity.channel = 'm';
    result_.material.texture = {};
  }

  /// What covers little of what lies behind it: windows are often written so.
  void read_film() {
    notices_.note("a surface with alpha below one half (alphaMode BLEND) is a thin pane of glass", place());
    const Vec3d colour = colour_of_base();
    SceneMaterial& material = result_.material.material;
    make_glass(vec::add(vec::scale(colour, alpha_), Vec3d{1 - alpha_, 1 - alpha_, 1 - alpha_}), true, material);
  }

  Vec3d colour_of_base() {
    if (!base_texture_) return surface_.colour;
    const auto texel = textures_.mean(*base_texture_, place());
    return texel ? vec::times(surface_.colour, texel->linear) : surface_.colour;
  }

  void make_glass(const Vec3d& transmittance, bool thin, SceneMaterial& material) const {
    material.kind = SurfaceKind::glass;
    material.thin = thin;
    material.diffuse = {0, 0, 0};
    material.specular = {0, 0, 0};
    material.exponent = 0;
    material.refractive_index = index_;
    for (std::size_t c = 0; c < 3; ++c) material.transmittance[c] = std::min(transmittance[c], 1.0);
  }

  void read_transmission() {
    const auto transmission = object_.extension("KHR_materials_transmission");
    if (!transmission) return;
    double share = transmission->number("transmissionFactor", 0, 1).value_or(0);
    if (share == 0) return;
    if (const auto texel = mean(transmission, "transmissionTexture")) share *= texel->raw[0];
    share *= 1 - surface_.metallic;
    if (emits()) return notices_.note("an emitter lets no light through; its transmission is not rendered", place());
    if (share < 0.5) return notices_.note("a transmission below one half is not rendered: it is opaque", place());
    if (share < 1) notices_.note("a transmission below one is read as one: all that is not reflected passes", place());
    if (surface_.roughness > kMirrorRoughness)
      notices_.note("frosted glass (transmission with roughness) is rendered as clear", place());
    const auto volume = object_.extension("KHR_materials_volume");
    const double thickness = volume ? volume->number("thicknessFactor", 0, kMost).value_or(0) : 0;
    Vec3d passes = colour_of_base();
    if (thickness > 0) passes = vec::times(passes, crossing(*volume, thickness));
    make_glass(passes, thickness == 0, result_.material.material);
  }

  /// What of light passes one of the two crossings of a body as thick as is told: the square root of what is left.
  Vec3d crossing(const GltfObject& volume, double thickness) {
    const Vec3d colour = volume.colour("attenuationColor").value_or(Vec3d{1, 1, 1});
    const double distance = volume.number("attenuationDistance", 0, std::numeric_limits<double>::max()).value_or(0);
    if (!(distance > 0)) return {1, 1, 1};  // absent: infinite
    if (colour != Vec3d{1, 1, 1})
      notices_.note("glass takes its colour where light crosses its surface, by its thicknessFactor", place());
    const auto left = [&](double one) { return std::pow(std::min(one, 1.0), 0.5 * thickness / distance); };
    return {left(colour[0]), left(colour[1]), left(colour[2])};
  }

  void tell_the_rest() {
    if (object_.has("normalTexture")) notices_.note("normal maps are not used", place());
    for (const std::string& name : object_.extension_names())
      if (std::ranges::find(kRead, name) == kRead.end())
        notices_.note("the material extension " + in_quotes(name) + " has no counterpart and is not rendered", place());
  }

  GltfObject object_;
  GltfTextures& textures_;
  GltfUnits units_;
  Notices& notices_;
  GltfMaterial result_;
  RoughSurface surface_;
  std::optional<GltfObject> base_texture_;
  double alpha_ = 1;
  double index_ = 1.5;
};

}  // namespace

GltfMaterial GltfMaterials::read(std::optional<std::size_t> number) {
  if (number)
    return Reader(root_.element("materials", *number, "material"), *number, textures_, units_, notices_).read();
  notices_.note("primitives without a material are white, diffuse with reflectance 0.99", root_.place());
  GltfMaterial none;
  none.material.material = white_material("(none)");
  none.material.place = root_.place();
  return none;
}

}  // namespace torolux
