// SPDX-License-Identifier: MIT
// Reads scene.toml: meshes, material overrides, lights, camera, defaults.
#include "host_tools/scene/scene_file.hpp"
#include "host_tools/settings/quality.hpp"

#include "host_tools/scene/camera.hpp"
#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/toml_table.hpp"

namespace torolux {
namespace {

constexpr double kMost = kMostCoordinate;

MeshEntry read_mesh(TomlTable table) {
  MeshEntry entry;
  entry.place = table.place();
  entry.file = table.required(table.text("file"), "file");
  if (entry.file.empty()) refuse(table.place("file"), "[[mesh]] 'file' is empty");
  if (const auto scale = table.triple("scale", -kMost, kMost, true)) entry.scale = *scale;
  for (const double s : entry.scale)
    if (!(std::abs(s) > 1e-15)) refuse(table.place("scale"), "[[mesh]] 'scale' is zero: nothing would be left");
  if (const auto rotate = table.triple("rotate", -36000, 36000, false)) entry.rotate = *rotate;
  if (const auto translate = table.triple("translate", -kMost, kMost, false)) entry.translate = *translate;
  entry.flip = table.flag("flip").value_or(false);
  entry.material = table.text("material");
  if (const toml::table* names = table.table("materials")) {
    for (const auto& [key, node] : *names) {
      const auto to = node.value<std::string>();
      if (!node.is_string() || !to) refuse(table.place("materials"), "[[mesh]] 'materials' must map names to names");
      entry.materials.emplace_back(std::string(key.str()), *to);
    }
  }
  table.finish();
  return entry;
}

MaterialOverride read_material(const std::string& name, TomlTable table) {
  MaterialOverride material;
  material.name = name;
  material.place = table.place();
  material.diffuse = table.triple("diffuse", 0, kMost, true);
  material.emission = table.triple("emission", 0, kMost, true);
  material.mirror = table.triple("mirror", 0, kMost, true);
  material.glass = table.number("glass", 0.2, 5);
  material.glossy = table.triple("glossy", 0, kMost, true);
  material.exponent = table.number("exponent", 0, kMost);
  material.transmittance = table.triple("transmittance", 0, 1, true);
  if ((material.diffuse ? 1 : 0) + (material.mirror ? 1 : 0) + (material.glass ? 1 : 0) > 1)
    refuse(material.place, "material '" + name + "' can have one of diffuse, mirror and glass");
  if (material.glossy && (material.mirror || material.glass))
    refuse(material.place, "material '" + name + "' can be glossy beside diffuse, not beside mirror or glass");
  if (material.exponent && !material.glossy)
    refuse(material.place, "material '" + name + "' has an exponent, which only glossy uses");
  table.finish();
  return material;
}

std::array<Vec3d, 4> rectangle(const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
  return {corner, vec::add(corner, u), vec::add(vec::add(corner, u), v), vec::add(corner, v)};
}

/// The width lies level; for a light that faces up or down along x.
std::array<Vec3d, 4> facing_rectangle(const Vec3d& centre, const std::array<double, 2>& size, const Vec3d& facing) {
  const Vec3d normal = vec::unit(facing);
  const Vec3d aside = std::abs(normal[1]) > 0.999 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
  const Vec3d u = vec::scale(vec::unit(vec::cross(aside, normal)), size[0]);
  const Vec3d v = vec::scale(vec::cross(normal, vec::unit(u)), size[1]);
  return rectangle(vec::subtract(centre, vec::scale(vec::add(u, v), 0.5)), u, v);
}

LightEntry read_light(TomlTable table) {
  LightEntry light;
  light.place = table.place();
  light.radiance = table.required(table.triple("radiance", 0, kMost, true), "radiance");
  if (!(vec::largest(light.radiance) > 0)) refuse(light.place, "[[light]] 'radiance' is zero");
  if (const auto diffuse = table.triple("diffuse", 0, 1, true)) light.diffuse = *diffuse;
  const auto corner = table.triple("corner", -kMost, kMost, false);
  const auto edges = table.two_vectors("edges", kMost);
  const auto centre = table.triple("centre", -kMost, kMost, false);
  const auto size = table.pair("size", 0, kMost);
  const auto facing = table.triple("facing", -kMost, kMost, false);
  table.finish();
  if (corner && edges && !centre && !size && !facing) {
    light.corners = rectangle(*corner, (*edges)[0], (*edges)[1]);
  } else if (centre && size && facing && !corner && !edges) {
    if (!(vec::length(*facing) > 0)) refuse(table.place("facing"), "[[light]] 'facing' is zero: no direction");
    light.corners = facing_rectangle(*centre, *size, *facing);
  } else {
    refuse(light.place, "[[light]] needs either 'corner' and 'edges', or 'centre', 'size' and 'facing'");
  }
  const Vec3d area =
      vec::cross(vec::subtract(light.corners[1], light.corners[0]), vec::subtract(light.corners[3], light.corners[0]));
  if (!(vec::length(area) > 0)) refuse(light.place, "[[light]] has no area");
  return light;
}

Camera read_camera(TomlTable table) {
  Camera camera;
  camera.eye = table.required(table.triple("eye", -kMost, kMost, false), "eye");
  camera.look_at = table.required(table.triple("look_at", -kMost, kMost, false), "look_at");
  if (const auto up = table.triple("up", -kMost, kMost, false)) camera.up = *up;
  camera.field_of_view_degrees = table.number("fov", 0.01, 179).value_or(camera.field_of_view_degrees);
  table.finish();
  if (const auto wrong = camera_fault(camera)) refuse(table.place(), "[camera] " + *wrong);
  return camera;
}

std::optional<std::uint32_t> narrow(std::optional<std::uint64_t> value) {
  if (!value) return std::nullopt;
  return static_cast<std::uint32_t>(*value);
}

SceneDefaults read_defaults(TomlTable table) {
  SceneDefaults d;
  d.width = narrow(table.integer("width", 1, 32768));
  d.height = narrow(table.integer("height", 1, 32768));
  d.samples = narrow(table.integer("samples", 1, kMostSamples));
  d.hemicube = narrow(table.integer("hemicube", 4, 256));
  if (d.hemicube && *d.hemicube % 2 != 0) refuse(table.place("hemicube"), "[defaults] 'hemicube' must be even");
  d.shot_points = narrow(table.integer("shot_points", 1, 64));
  d.emission_records = narrow(table.integer("emission_records", 0, kMostEmissionRecords));
  d.max_shots = narrow(table.integer("max_shots", 0, 0xFFFF'FFFFU));
  d.bounces = narrow(table.integer("bounces", 1, 255));
  d.texels = narrow(table.integer("texels", 1, 4U << 20U));
  d.exposure_ev = table.number("exposure", -50, 50);
  d.patch_length = table.number("patches", 1e-15, kMost);
  d.element_length = table.number("elements", 1e-15, kMost);
  d.refine = table.number("refine", 0, 100);
  d.unshot = table.number("unshot", 0, 1);
  d.subspaces = table.text("subspaces");
  d.allocation = table.text("allocation");
  d.filter = table.text("filter");
  d.quality = table.text("quality");
  if (d.quality) d.quality_place = table.place("quality").text();
  if (d.filter) d.filter_place = table.place("filter").text();
  if (d.subspaces) d.subspaces_place = table.place("subspaces").text();
  if (d.allocation) d.allocation_place = table.place("allocation").text();
  d.two_sided_lights = table.flag("two_sided_lights");
  d.shadow_rays = table.flag("shadow_rays");
  d.seed = table.integer("seed", 0, 0x7FFF'FFFF'FFFF'FFFFU);
  table.finish();
  return d;
}

}  // namespace

SceneFile read_scene_file(std::string_view text, const std::string& file) {
  const toml::table root = parse_toml(text, file);
  TomlTable table(root, file, "the scene");
  SceneFile scene;
  scene.name = table.text("name");
  for (const toml::table* mesh : table.tables("mesh")) scene.meshes.push_back(read_mesh({*mesh, file, "[[mesh]]"}));
  if (const toml::table* materials = table.table("material")) {
    for (const auto& [key, node] : *materials) {
      const std::string name(key.str());
      if (!node.is_table())
        refuse(place_of(node, file), "material '" + name + "' must be a table: write [material." + name + "]");
      scene.materials.push_back(read_material(name, {*node.as_table(), file, "[material." + name + "]"}));
    }
  }
  for (const toml::table* light : table.tables("light"))
    scene.lights.push_back(read_light({*light, file, "[[light]]"}));
  if (const toml::table* camera = table.table("camera")) scene.camera = read_camera({*camera, file, "[camera]"});
  if (const toml::table* defaults = table.table("defaults"))
    scene.defaults = read_defaults({*defaults, file, "[defaults]"});
  table.finish();
  return scene;
}

}  // namespace torolux
