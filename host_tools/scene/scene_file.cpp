// SPDX-License-Identifier: MIT
// Reads scene.toml: meshes, material overrides, lights, shapes, camera, defaults.
#include "host_tools/scene/scene_file.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <variant>

#include "emulator/nearest_name.hpp"
#include "host_tools/scene/camera_entry.hpp"
#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/sky_entry.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/toml_table.hpp"

namespace torolux {
namespace {

constexpr double kMost = kMostCoordinate;

/// How the mesh, or an instance of it, is placed and made; what `table` does not say stays.
void read_placing(TomlTable& table, MeshEntry& entry) {
  entry.place = table.place();
  if (const auto scale = table.triple("scale", -kMost, kMost, true)) entry.scale = *scale;
  for (const double s : entry.scale)
    if (!(std::abs(s) > 1e-15)) refuse(table.place("scale"), table.title() + " 'scale' is zero: nothing would be left");
  if (const auto rotate = table.triple("rotate", -36000, 36000, false)) entry.rotate = *rotate;
  if (const auto translate = table.triple("translate", -kMost, kMost, false)) entry.translate = *translate;
  if (const auto flip = table.flag("flip")) entry.flip = *flip;
  if (const auto material = table.text("material")) entry.material = material;
  if (const toml::table* names = table.table("materials")) {
    entry.materials.clear();
    for (const auto& [key, node] : *names) {
      const auto to = node.value<std::string>();
      if (!node.is_string() || !to)
        refuse(table.place("materials"), table.title() + " 'materials' must map names to names");
      entry.materials.emplace_back(std::string(key.str()), *to);
    }
  }
}

MeshFile read_mesh(TomlTable table) {
  MeshFile mesh;
  mesh.place = table.place();
  mesh.file = table.required(table.text("file"), "file");
  if (mesh.file.empty()) refuse(table.place("file"), "[[mesh]] 'file' is empty");
  MeshEntry whole;
  read_placing(table, whole);
  for (const toml::table* instance : table.tables("instance")) {
    TomlTable keys(*instance, mesh.place.file, "[[mesh.instance]]");
    read_placing(keys, mesh.instances.emplace_back(whole));
    keys.finish();
  }
  if (mesh.instances.empty()) mesh.instances.push_back(whole);
  table.finish();
  return mesh;
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
  material.thin = table.flag("thin");
  if (material.thin.value_or(false) && !material.glass)
    refuse(material.place,
           "material '" + name + "' is thin, which only glass can be: give its 'glass', a refractive index");
  if ((material.diffuse ? 1 : 0) + (material.mirror ? 1 : 0) + (material.glass ? 1 : 0) > 1)
    refuse(material.place, "material '" + name + "' can have one of diffuse, mirror and glass");
  if (material.glossy && (material.mirror || material.glass))
    refuse(material.place, "material '" + name + "' can be glossy beside diffuse, not beside mirror or glass");
  if (material.exponent && !material.glossy)
    refuse(material.place, "material '" + name + "' has an exponent, which only glossy uses");
  table.finish();
  return material;
}

LightEntry read_light(TomlTable table) {
  LightEntry light;
  light.place = table.place();
  light.radiance = table.required(table.triple("radiance", 0, kMost, true), "radiance");
  if (!(vec::largest(light.radiance) > 0)) refuse(light.place, "[[light]] 'radiance' is zero");
  if (const auto diffuse = table.triple("diffuse", 0, 1, true)) light.diffuse = *diffuse;
  const RectangleKeys rectangle(table);
  table.finish();
  light.corners = rectangle.corners(table);
  return light;
}

/// Reads an option's key of [defaults] into settings, in which it is then given.
class DefaultReader {
 public:
  DefaultReader(const Option& option, TomlTable& table, GivenSettings& given)
      : option_(option), table_(table), given_(given) {}

  template <class Integer>
  void operator()(const option::Count<Integer>& kind) const {
    constexpr std::uint64_t kMostInToml = std::numeric_limits<std::int64_t>::max();
    const auto value = table_.integer(key(), kind.least, std::min(kind.most, kMostInToml));
    if (!value) return;
    if (kind.even && *value % 2 != 0)
      refuse(table_.place(key()), "[defaults] '" + option_.scene_key + "' must be even");
    kind.member.in(given_.give(option_)) = static_cast<Integer>(*value);
  }
  void operator()(const option::Number& kind) const { put(kind.member, table_.number(key(), kind.least, kind.most)); }
  void operator()(const option::Length& kind) const { put(kind.member, table_.number(key(), 1e-15, kMost)); }
  void operator()(const option::Fraction& kind) const { put(kind.member, table_.number(key(), 0, 1)); }
  void operator()(const option::Flag& kind) const { put(kind.member, table_.flag(key())); }
  void operator()(const option::Choice& kind) const {
    if (kind.flag_in_scene) {
      if (const auto flag = table_.flag(key())) kind.member.put(given_.give(option_), *flag ? 1 : 0);
      return;
    }
    const auto name = table_.text(key());
    if (!name) return;
    const auto found = std::ranges::find(kind.names, *name);
    if (found == kind.names.end())
      refuse(table_.place(key()), "[defaults] '" + option_.scene_key +
                                      "': " + no_such_name(*name, kind.kind, {kind.names.begin(), kind.names.end()}));
    kind.member.put(given_.give(option_), static_cast<std::size_t>(found - kind.names.begin()));
  }
  void operator()(const option::White& kind) const {
    const auto value = table_.number_or_text(key(), kLeastWhiteKelvin, kMostWhiteKelvin);
    if (!value) return;
    WhiteBalance& white = kind.member.in(given_.give(option_));
    if (const auto* kelvin = std::get_if<double>(&*value))
      white = {WhiteBalance::Kind::kelvin, *kelvin};
    else if (const auto& name = std::get<std::string>(*value); name == "auto" || name == "off")
      white = {name == "auto" ? WhiteBalance::Kind::automatic : WhiteBalance::Kind::off, 0};
    else
      refuse(table_.place(key()),
             "[defaults] '" + option_.scene_key + "' is " + in_quotes(name) + "; expected kelvin, \"auto\" or \"off\"");
  }
  template <class Kind>
  void operator()(const Kind& kind) const {
    static_cast<void>(kind);
    throw std::logic_error("a scene has no form for " + option_.name);
  }

 private:
  std::string_view key() const { return option_.scene_key; }
  template <class Value, class Read>
  void put(const option::Member<Value>& member, const std::optional<Read>& value) const {
    if (value) member.in(given_.give(option_)) = *value;
  }

  const Option& option_;
  TomlTable& table_;
  GivenSettings& given_;
};

SceneDefaults read_defaults(TomlTable table) {
  SceneDefaults defaults;
  for (const Option& option : all_options()) {
    if (!option.scene_key.empty()) std::visit(DefaultReader(option, table, defaults.given), option.kind);
  }
  const auto text = [&table](std::string_view key) -> std::optional<PlacedText> {
    const auto value = table.text(key);
    return value ? std::optional(PlacedText{*value, table.place(key).text()}) : std::nullopt;
  };
  defaults.subspaces = text("subspaces");
  defaults.allocation = text("allocation");
  defaults.quality = text("quality");
  table.finish();
  return defaults;
}

void read_shapes(TomlTable& table, const std::string& file, SceneFile& scene) {
  if (const toml::table* room = table.table("room")) scene.room = read_room({*room, file, "[room]"}, *room);
  using Read = ShapeEntry (*)(TomlTable);
  constexpr std::array<std::pair<const char*, Read>, 6> kinds{{{"sphere", read_sphere},
                                                               {"box", read_box},
                                                               {"quad", read_quad},
                                                               {"disc", read_disc},
                                                               {"cylinder", read_cylinder},
                                                               {"torus", read_torus}}};
  for (const auto& [kind, read] : kinds)
    for (const toml::table* shape : table.tables(kind))
      scene.shapes.push_back(read({*shape, file, "[[" + std::string(kind) + "]]"}));
  for (const toml::table* lamp : table.tables("lamp")) scene.lamps.push_back(read_lamp({*lamp, file, "[[lamp]]"}));
}

/// Pictures are called by it.
std::optional<std::string> read_name(TomlTable& table) {
  std::optional<std::string> name = table.text("name");
  const auto is_wrong = [](char c) { return c == '/' || (c >= 0 && c < ' '); };
  if (name && (name->find_first_not_of(' ') == std::string::npos || std::ranges::any_of(*name, is_wrong)))
    refuse(table.place("name"), "the scene's 'name' is " + in_quotes(*name) +
                                    "; its picture is called by it, so it must have letters, and no / and no line "
                                    "ends. Without 'name' it is the folder's");
  return name;
}

}  // namespace

SceneFile read_scene_file(std::string_view text, const std::string& file) {
  const toml::table root = parse_toml(text, file);
  TomlTable table(root, file, "the scene");
  SceneFile scene;
  scene.name = read_name(table);
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
  read_shapes(table, file, scene);
  if (const toml::table* sky = table.table("sky")) scene.sky = read_sky({*sky, file, "[sky]"}, scene.sky_image);
  if (const toml::table* camera = table.table("camera")) {
    TomlTable entry(*camera, file, "[camera]");
    scene.camera = read_camera(entry, "[camera]");
    entry.finish();
  }
  if (const toml::table* defaults = table.table("defaults"))
    scene.defaults = read_defaults({*defaults, file, "[defaults]"});
  table.finish();
  return scene;
}

}  // namespace torolux
