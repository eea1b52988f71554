// SPDX-License-Identifier: MIT
// Renames and overrides materials, and decides which of their faults count.
#include "host_tools/scene/resolve_material.hpp"

#include <algorithm>

#include "emulator/nearest_name.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

const MaterialOverride* find(const std::vector<MaterialOverride>& overrides, const std::string& name) {
  for (const MaterialOverride& o : overrides)
    if (o.name == name) return &o;
  return nullptr;
}

void apply(const MaterialOverride& o, SceneMaterial& material) {
  if (o.diffuse) {
    material.kind = SurfaceKind::diffuse;
    material.diffuse = *o.diffuse;
    material.specular = {0, 0, 0};
  }
  if (o.mirror) {
    material.kind = SurfaceKind::mirror;
    material.specular = *o.mirror;
  }
  if (o.glass) {
    material.kind = SurfaceKind::glass;
    material.refractive_index = *o.glass;
    material.thin = o.thin.value_or(false);
    material.thin_where_open = false;
  }
  if (o.glossy) {
    if (material.kind != SurfaceKind::diffuse) material.diffuse = {0, 0, 0};
    material.kind = SurfaceKind::diffuse;
    material.specular = *o.glossy;
    material.exponent = o.exponent.value_or(1);
  }
  if (o.transmittance) material.transmittance = *o.transmittance;
  if (o.emission) material.emission = *o.emission;
  if (material.kind != SurfaceKind::diffuse) material.diffuse = {0, 0, 0};
  if (material.kind == SurfaceKind::glass) material.specular = {0, 0, 0};
}

/// The mesh's material of this number as the scene has it: renamed and overridden.
ImportedMaterial resolved(const ImportedMesh& mesh, std::size_t number, const MeshEntry& entry,
                          const std::vector<MaterialOverride>& overrides) {
  ImportedMaterial result = mesh.materials[number];
  std::string name = result.material.name;
  for (const auto& [from, to] : entry.materials)
    if (from == name) result.material.name = to;
  if (entry.material) result.material.name = *entry.material;
  if (result.material.name != name) {
    name = result.material.name;
    const auto own = std::find_if(mesh.materials.begin(), mesh.materials.end(),
                                  [&name](const ImportedMaterial& m) { return m.defined && m.material.name == name; });
    result.defined = own != mesh.materials.end();
    result.material = result.defined ? own->material : SceneMaterial{};
    result.material.name = name;
    result.texture = result.defined ? own->texture : TextureUse{};
    result.opacity = result.defined ? own->opacity : TextureUse{};
    result.faults = result.defined ? own->faults : std::vector<MaterialFault>{};
    result.place = entry.place;
  }
  if (const MaterialOverride* o = find(overrides, name)) {
    apply(*o, result.material);
    if (o->diffuse) result.texture = {};
    if (o->diffuse || o->mirror || o->glass) result.opacity = {};
    result.defined = true;
    result.place = o->place;
  }
  return result;
}

[[noreturn]] void refuse_unknown(const ImportedMaterial& material, const ImportedMesh& mesh,
                                 const std::vector<MaterialOverride>& overrides) {
  const std::string which = "material " + in_quotes(material.material.name);
  if (!mesh.missing_libraries.empty()) {
    const auto& [name, place] = mesh.missing_libraries.front();
    const std::string path = (std::filesystem::path(mesh.file).parent_path() / name).lexically_normal().string();
    refuse(place, "there is no material library '" + path + "', and " + which + " is not defined elsewhere; put it " +
                      "there, give the material in scene.toml, or use --missing-materials white");
  }
  std::vector<std::string> known;
  for (const ImportedMaterial& m : mesh.materials)
    if (m.defined) known.push_back(m.material.name);
  for (const MaterialOverride& o : overrides) known.push_back(o.name);
  const std::string near = did_you_mean(material.material.name, known);
  refuse(material.place, which + " is not defined in any material library" + near +
                             (near.empty() ? "; " : " Otherwise ") +
                             "name the library with mtllib, define it in scene.toml, or use --missing-materials white");
}

/// Does what is seen depend on this value?
bool needs(const ImportedMaterial& material, const MaterialOverride& o, MaterialValue value) {
  const SurfaceKind kind = material.material.kind;
  const bool kind_given = o.diffuse || o.mirror || o.glass;
  switch (value) {
    case MaterialValue::emission:
      return !o.emission;
    case MaterialValue::model:
      return !kind_given;
    case MaterialValue::diffuse:
      return kind == SurfaceKind::diffuse && !o.diffuse;
    case MaterialValue::texture:
      return kind == SurfaceKind::diffuse && !o.diffuse && material.texture.present();
    case MaterialValue::opacity:
      return kind != SurfaceKind::glass && material.opacity.present();
    case MaterialValue::specular:
      return !kind_given && !o.glossy && material.material.specular != Vec3d{0, 0, 0};
    case MaterialValue::exponent:
      return !o.glossy && is_glossy(material.material);
    case MaterialValue::index:
      return kind == SurfaceKind::glass && !o.glass;
    case MaterialValue::filter:
      return kind == SurfaceKind::glass && !o.transmittance;
  }
  return true;
}

}  // namespace

void tell_faults(const std::vector<MaterialFault>& faults, Notices& notices) {
  for (const MaterialFault& fault : faults)
    notices.note("a value is not right, but the material does not need it", fault.place, fault.message);
}

ImportedMaterial resolve_material(const ImportedMesh& mesh, std::size_t number, const MeshEntry& entry,
                                  const std::vector<MaterialOverride>& overrides, MissingMaterials missing,
                                  Notices& notices) {
  ImportedMaterial material = resolved(mesh, number, entry, overrides);
  const std::string& name = material.material.name;
  if (!material.defined) {
    if (missing == MissingMaterials::refuse) refuse_unknown(material, mesh, overrides);
    notices.note("a material that is not defined is white, diffuse with reflectance 0.99", material.place,
                 in_quotes(name));
    material.material = white_material(name);
  }
  const MaterialOverride* given = find(overrides, name);
  for (const MaterialFault& fault : material.faults)
    if (needs(material, given == nullptr ? MaterialOverride{} : *given, fault.value))
      refuse(fault.place, fault.message);
  tell_faults(material.faults, notices);
  if (given != nullptr && given->transmittance && material.material.kind != SurfaceKind::glass)
    notices.note("a material has a transmittance, which only glass uses: give its 'glass', a refractive index, too",
                 given->place, in_quotes(name));
  return material;
}

}  // namespace torolux
