// SPDX-License-Identifier: MIT
// Lets tinyobjloader read the good statements of a material library, and maps them to light transport.
#include "host_tools/scene/mtl.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <unordered_map>

#include "host_tools/scene/mtl_check.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/tinyobj.hpp"

namespace torolux {
namespace {

Vec3d triple(const tinyobj::real_t (&values)[3]) {
  return {values[0], values[1], values[2]};
}

bool is_zero(const Vec3d& v) {
  return v == Vec3d{0, 0, 0};
}

bool is_grey(const Vec3d& v) {
  constexpr double told_apart = 0.004;  // of one step of eight bits
  return std::max({v[0], v[1], v[2]}) - std::min({v[0], v[1], v[2]}) < told_apart;
}

/// Blender has no place in MTL for what makes a metal: it writes illum 3, the metal's colour as Kd, and its setting
/// "specular", which does nothing on metals, as a grey Ks.
void set_mirror(const Vec3d& specular, const Vec3d& diffuse, const CheckedMaterial& checked, SceneMaterial& material,
                Notices& notices) {
  material.kind = SurfaceKind::mirror;
  material.specular = specular;
  if (is_grey(specular) && !is_grey(diffuse)) {
    material.specular = diffuse;
    notices.note("a mirror with a grey Ks and a coloured Kd is a metal as Blender writes it: it reflects Kd",
                 checked.place);
  } else if (!is_zero(diffuse) || checked.texture.present()) {
    notices.note("a mirror reflects by Ks alone; its Kd is not used", checked.place);
  }
}

bool models_transparency(int illum) {
  return illum == 4 || illum == 6 || illum == 9;
}

/// How much of what lies behind a surface it covers, 0..1. Of both statements d counts: Tr is written in two ways, and
/// where it is 1 it may be meant either way.
double covering(const tinyobj::material_t& read, const CheckedMaterial& checked, Notices& notices) {
  if (checked.dissolve) return *checked.dissolve;
  if (!checked.transparency) return 1;
  if (*checked.transparency == 1 && !models_transparency(read.illum)) {
    notices.note("Tr 1 without d is written for clear and for opaque: it is opaque; give d", checked.place);
    return 1;
  }
  return 1 - *checked.transparency;
}

/// Transparent as files have it that do not say illum 7. Absent: it is opaque, which is told where something says
/// otherwise.
std::optional<SceneMaterial> clear_material(const tinyobj::material_t& read, const CheckedMaterial& checked,
                                            Notices& notices) {
  const double covers = covering(read, checked, notices);
  const Vec3d filter = triple(read.transmittance);
  const bool filters = !is_zero(filter) && std::ranges::any_of(filter, [](double one) { return one < 1; });
  const bool meant = models_transparency(read.illum);
  if (meant && covers == 1 && !filters) {
    notices.note("illum 4, 6 and 9 without d below 1 and without a Tf are read as diffuse; glass is illum 7",
                 checked.place);
    return std::nullopt;
  }
  if (!meant && covers == 1) return std::nullopt;
  if (!is_zero(triple(read.emission)) || checked.opacity.present()) {
    notices.note("transparency by d or Tr of what emits, or is cut out by map_d, is not used", checked.place);
    return std::nullopt;
  }
  if (!meant && !(covers < 0.5)) {
    notices.note("half transparency is not rendered: what has d of one half and more is there", checked.place);
    return std::nullopt;
  }
  SceneMaterial material;
  material.name = checked.name;
  material.kind = SurfaceKind::glass;
  material.thin_where_open = true;
  const Vec3d colour = triple(read.diffuse);
  for (std::size_t c = 0; c < 3; ++c) {
    const double passes = 1 - covers + covers * std::min(colour[c], 1.0);
    material.transmittance[c] = passes * (is_zero(filter) ? 1 : std::min(filter[c], 1.0));
  }
  const bool known = checked.has_ni && read.ior >= 0.2 && read.ior <= 5;
  if (known) material.refractive_index = read.ior;
  if (!known) notices.note("a transparent material without an Ni of 0.2 to 5: 1.5 is taken", checked.place);
  if (checked.texture.present()) notices.note("glass and panes show no texture (map_Kd)", checked.place);
  return material;
}

SceneMaterial mapped(const tinyobj::material_t& read, const CheckedMaterial& checked, Notices& notices) {
  SceneMaterial material;
  material.name = checked.name;
  material.emission = triple(read.emission);
  const Vec3d specular = triple(read.specular);
  const bool mirror = (read.illum == 3 || read.illum == 5) && !is_zero(specular);
  if (read.illum == 7) {
    material.kind = SurfaceKind::glass;
    const Vec3d filter = triple(read.transmittance);
    material.transmittance = is_zero(filter) ? Vec3d{1, 1, 1} : filter;
    if (checked.has_ni)
      material.refractive_index = read.ior;
    else
      notices.note("glass without Ni: 1.5 is taken", checked.place);
    return material;
  }
  if (mirror) {
    set_mirror(specular, triple(read.diffuse), checked, material, notices);
    return material;
  }
  if (const auto clear = clear_material(read, checked, notices)) return *clear;
  material.diffuse = triple(read.diffuse);
  if (checked.texture.present() && is_zero(material.diffuse)) {
    if (checked.has_kd) notices.note("a texture (map_Kd) times Kd 0 would be black: Kd 1 is taken", checked.place);
    material.diffuse = {1, 1, 1};
  } else if (!checked.has_kd && is_zero(material.emission)) {
    notices.note("material without Kd is black", checked.place);
  }
  if (read.illum == 2 && !is_zero(specular)) {
    material.specular = specular;
    material.exponent = checked.has_ns ? read.shininess : 1;
    if (!checked.has_ns) notices.note("a glossy surface (illum 2 with Ks) without Ns: 1 is taken", checked.place);
  } else if (!is_zero(specular)) {
    notices.note("Ks is used for glossy surfaces (illum 2) and mirrors (3, 5) alone; this one is diffuse by Kd",
                 checked.place);
  }
  return material;
}

bool same(const TextureUse& a, const TextureUse& b) {
  return a.names == b.names && a.scale == b.scale && a.offset == b.offset && a.clamp == b.clamp && a.base == b.base &&
         a.gain == b.gain && a.channel == b.channel;
}

/// Equal but for where it stands.
bool same(const ImportedMaterial& a, const ImportedMaterial& b) {
  const auto alike = [](const MaterialFault& x, const MaterialFault& y) {
    return x.value == y.value && x.message == y.message;
  };
  return a.material == b.material && same(a.texture, b.texture) && same(a.opacity, b.opacity) &&
         std::ranges::equal(a.faults, b.faults, alike);
}

/// A name given again: the last counts.
void replace(ImportedMaterial& earlier, ImportedMaterial&& later, Notices& notices) {
  const std::string which = in_quotes(later.material.name) + ", first at " + earlier.place.text();
  if (same(earlier, later)) {
    notices.note("a material is given again, the same", later.place, which);
    return;
  }
  notices.note("a material is given again, another one: this last one counts", later.place, which);
  earlier = std::move(later);
}

}  // namespace

void import_mtl(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                std::vector<ImportedMaterial>& materials, Notices& notices) {
  CheckedLibrary library = check_mtl(text, file, folder, notices);
  std::map<std::string, int> names;
  std::vector<tinyobj::material_t> read;
  std::istringstream stream(library.text);
  std::string warning;
  std::string error;
  tinyobj::LoadMtl(&names, &read, &stream, &warning, &error);

  std::unordered_map<std::string, std::size_t> number;
  for (std::size_t i = 0; i < materials.size(); ++i) number.emplace(materials[i].material.name, i);
  // An empty library still gives tinyobjloader's own default material.
  for (std::size_t i = 0; i < library.materials.size(); ++i) {
    CheckedMaterial& checked = library.materials[i];
    ImportedMaterial material{mapped(read.at(i), checked, notices),
                              true,
                              checked.place,
                              std::move(checked.texture),
                              std::move(checked.opacity),
                              std::move(checked.faults)};
    const auto [entry, fresh] = number.emplace(checked.name, materials.size());
    if (fresh)
      materials.push_back(std::move(material));
    else
      replace(materials[entry->second], std::move(material), notices);
  }
}

}  // namespace torolux
