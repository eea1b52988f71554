// SPDX-License-Identifier: MIT
// A scene and settings enter; what a solution of them depends on leaves, as bytes of the radiosity file and back; and
// where another run's differs, the refusal.
#include "host_tools/solution/radiosity_origin.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "emulator/errors.hpp"
#include "host_tools/settings/options.hpp"
#include "host_tools/settings/overloaded.hpp"
#include "host_tools/settings/presets.hpp"

namespace torolux {
namespace {

/// FNV-1a over 64-bit words, with a final mix: names a scene, no defence against malice.
class Hash {
 public:
  void add(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x0000'0100'0000'01B3U;
    value_ ^= value_ >> 29U;
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const Vec3d& v) {
    for (const double value : v) add(value);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF2'9CE4'8422'2325U;
};

/// Where the origin has what is no option.
constexpr std::size_t kGeometryAt = 0, kMaterialsAt = 8, kPatchSidesAt = 100, kElementsAt = 104;

/// Where it has an option of the table, by its key: a length or number as a double (0: auto), a seed in 8 bytes, all
/// else in 4. In the order in which messages tell what differs.
struct Field {
  std::string_view key;
  std::size_t at;
};
constexpr std::array<Field, 17> kFields{{{"patch_factor", 32},
                                         {"patches", 16},
                                         {"elements", 24},
                                         {"refine", 56},
                                         {"unshot", 64},
                                         {"seed", 72},
                                         {"hemicube", 80},
                                         {"shot_points", 84},
                                         {"emission_records", 108},
                                         {"final_gather", 120},
                                         {"max_shots", 88},
                                         {"bounces", 92},
                                         {"texels", 112},
                                         {"direct", 116},
                                         {"element_factor", 40},
                                         {"cluster_factor", 48},
                                         {"two_sided_lights", 96}}};

const Option& option_of_field(const Field& field) {
  const auto found = std::ranges::find(all_options(), field.key, &Option::key);
  if (found == all_options().end()) throw std::logic_error("a field of the radiosity file that is no option");
  return *found;
}

template <class Value>
void put_at(std::span<std::byte> origin, std::size_t at, const Value& value) {
  std::memcpy(origin.subspan(at).data(), &value, sizeof value);
}
template <class Value>
Value take_at(std::span<const std::byte> origin, std::size_t at) {
  Value value{};
  std::memcpy(&value, origin.subspan(at).data(), sizeof value);
  return value;
}

/// For kinds that no field has.
[[noreturn]] void refuse_kind() {
  throw std::logic_error("the radiosity file has no form for an option of this kind");
}

void put_field(const Field& field, const AllSettings& settings, std::span<std::byte> origin) {
  const auto number = [&](auto value) { put_at(origin, field.at, static_cast<std::uint32_t>(value)); };
  std::visit(Overloaded{
                 [&](const option::Length& kind) { put_at(origin, field.at, kind.member.of(settings).value_or(0)); },
                 [&](const option::Number& kind) { put_at(origin, field.at, kind.member.of(settings)); },
                 [&](const option::Count<std::uint64_t>& kind) { put_at(origin, field.at, kind.member.of(settings)); },
                 [&](const option::Count<std::uint32_t>& kind) { number(kind.member.of(settings)); },
                 [&](const option::Choice& kind) { number(kind.member.of(settings)); },
                 [&](const option::Flag& kind) { number(kind.member.of(settings)); },
                 [](const auto&) { refuse_kind(); },
             },
             option_of_field(field).kind);
}

void take_field(const Field& field, std::span<const std::byte> origin, AllSettings& settings) {
  const auto number = [&] { return take_at<std::uint32_t>(origin, field.at); };
  std::visit(Overloaded{
                 [&](const option::Length& kind) {
                   const auto length = take_at<double>(origin, field.at);
                   kind.member.in(settings) = length == 0 ? std::nullopt : std::optional(length);
                 },
                 [&](const option::Number& kind) { kind.member.in(settings) = take_at<double>(origin, field.at); },
                 [&]<class Integer>(const option::Count<Integer>& kind) {
                   kind.member.in(settings) = take_at<Integer>(origin, field.at);
                 },
                 [&](const option::Choice& kind) {
                   kind.member.put(settings, std::min<std::size_t>(number(), kind.names.size() - 1));
                 },
                 [&](const option::Flag& kind) { kind.member.in(settings) = number() != 0; },
                 [](const auto&) { refuse_kind(); },
             },
             option_of_field(field).kind);
}

/// A setting that the saved radiosities were made with, and this run's, where they differ.
struct Difference {
  std::string option;
  std::string was, is;
};

std::string quality_name(double patch_factor) {
  for (const Preset& preset : kPresets)
    if (preset.quality.patch_factor == patch_factor) return std::string(preset.name);
  return std::to_string(patch_factor) + " times as long patches";
}

std::vector<Difference> differences(const Quality& saved, const Quality& run) {
  const AllSettings was{saved, {}, {}};
  const AllSettings is{run, {}, {}};
  std::vector<Difference> found;
  // A preset brings many settings with it; they are named where the preset is the same.
  const bool same_preset = saved.patch_factor == run.patch_factor;
  if (!same_preset) found.push_back({"--quality", quality_name(saved.patch_factor), quality_name(run.patch_factor)});
  for (const Field& field : kFields) {
    const Option& option = option_of_field(field);
    const bool has_words = !option.name.empty() && !std::holds_alternative<option::Flag>(option.kind);
    if (!has_words || same_value(option, was, is)) continue;
    const bool of_preset = option.in_presets || std::holds_alternative<option::Length>(option.kind);
    if (of_preset && !same_preset) continue;
    // Without a draft nothing was split for the sake of either way, and without final gathering no light is missing
    // for it: the file serves both.
    if (option.key == "direct" && !(saved.refine > 0) && saved.final_gather == 0) continue;
    found.push_back({option.name, value_text(option, was), value_text(option, is)});
  }
  return found;
}

std::uint64_t hash_of_geometry(const Scene& scene) {
  Hash geometry;
  for (const Vec3d& position : scene.positions) geometry.add(position);
  for (const Vec3d& normal : scene.normals) geometry.add(normal);
  for (const auto& [u, v] : scene.texture_points) {
    geometry.add(u);
    geometry.add(v);
  }
  for (const SceneTriangle& triangle : scene.triangles) {
    for (const std::uint32_t index : triangle.position) geometry.add(std::uint64_t{index});
    for (const std::uint32_t index : triangle.normal) geometry.add(std::uint64_t{index});
    geometry.add(std::uint64_t{triangle.material});
    geometry.add(std::uint64_t{triangle.texture_points});
  }
  return geometry.value();
}

void add_sky(const Sky& sky, Hash& hash) {
  for (const Vec3d& axis : {sky.east, sky.north, sky.up, sky.sun, sky.sun_irradiance}) hash.add(axis);
  for (const Vec3d& radiance : sky.radiance) hash.add(radiance);
  for (const SkyQuad& quad : sky.openings)
    for (const Vec3d& v : {quad.corner, quad.along, quad.across}) hash.add(v);
}

void add_lamps(const Scene& scene, Hash& hash) {
  for (const SceneLamp& lamp : scene.lamps) {
    hash.add(std::uint64_t{lamp.web});
    for (const Vec3d& axis : {lamp.x, lamp.y, lamp.nadir}) hash.add(axis);
  }
  for (const LampWeb& web : scene.webs)
    for (const auto* values : {&web.gamma, &web.turn, &web.intensity})
      for (const double value : *values) hash.add(value);
}

std::uint64_t hash_of_materials(const Scene& scene) {
  Hash materials;
  for (const SceneMaterial& material : scene.materials) {
    materials.add(static_cast<std::uint64_t>(material.kind));
    materials.add(material.diffuse);
    materials.add(material.specular);
    materials.add(material.exponent);
    materials.add(std::uint64_t{material.texture});
    materials.add(material.transmittance);
    materials.add(material.refractive_index);
    materials.add(material.emission);
    if (material.lamp != kNoMeasuredLamp) materials.add(std::uint64_t{material.lamp});
  }
  for (const SceneTexture& texture : scene.textures) {
    materials.add((std::uint64_t{texture.width} << 32U) | texture.height);
    for (const auto& [r, g, b] : texture.texels)
      materials.add((std::uint64_t{r} << 16U) | (std::uint64_t{g} << 8U) | b);
    if (texture.clamped) materials.add(std::uint64_t{1});
  }
  if (scene.sky) add_sky(*scene.sky, materials);
  add_lamps(scene, materials);
  return materials.value();
}

}  // namespace

RadiosityOrigin radiosity_origin(const Scene& scene, const Quality& quality, const Mesh& mesh) {
  const AllSettings all{quality, {}, {}};
  AllSettings bearing;
  for (const Field& field : kFields) copy_value(option_of_field(field), all, bearing);
  return {hash_of_geometry(scene), hash_of_materials(scene), bearing.quality, mesh.patch_sides, mesh.elements};
}

OriginBytes bytes_of(const RadiosityOrigin& origin) {
  OriginBytes bytes{};
  put_at(bytes, kGeometryAt, origin.geometry);
  put_at(bytes, kMaterialsAt, origin.materials);
  put_at(bytes, kPatchSidesAt, origin.patch_sides);
  put_at(bytes, kElementsAt, origin.elements);
  const AllSettings settings{origin.quality, {}, {}};
  for (const Field& field : kFields) put_field(field, settings, bytes);
  return bytes;
}

RadiosityOrigin origin_of(const OriginBytes& bytes) {
  AllSettings settings;
  for (const Field& field : kFields) take_field(field, bytes, settings);
  return {take_at<std::uint64_t>(bytes, kGeometryAt), take_at<std::uint64_t>(bytes, kMaterialsAt), settings.quality,
          take_at<std::uint32_t>(bytes, kPatchSidesAt), take_at<std::uint32_t>(bytes, kElementsAt)};
}

/// Throws InputError with what differs, and the options that mend it.
void check_origin_settings(const RadiosityOrigin& saved, const RadiosityOrigin& run, const std::string& name) {
  const auto refuse = [&name](const std::string& what) {
    throw InputError(name + ": these radiosities were made with " + what);
  };
  if (saved.geometry != run.geometry) refuse("other geometry; make them anew, with --save-radiosity");
  if (saved.materials != run.materials) refuse("other materials or lights; make them anew, with --save-radiosity");
  if (saved.quality.two_sided_lights != run.quality.two_sided_lights)
    refuse(saved.quality.two_sided_lights ? "--two-sided-lights; give it"
                                          : "lights of one side; leave --two-sided-lights out");
  const std::vector<Difference> found = differences(saved.quality, run.quality);
  std::string options;
  for (const Difference& difference : found) options += " " + difference.option + " " + difference.was;
  if (!found.empty())
    refuse(found[0].option + " " + found[0].was + ", this run has " + found[0].is + "; give" + options +
           ", or make them anew, with --save-radiosity");
  if (saved.quality.element_factor != run.quality.element_factor ||
      saved.quality.cluster_factor != run.quality.cluster_factor)
    refuse("another --quality, or with --elements of another length");
}

}  // namespace torolux
