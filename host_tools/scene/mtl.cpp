// SPDX-License-Identifier: MIT
// Checks each statement of a material library, lets tinyobjloader read the good ones, and maps them to light transport.
#include "host_tools/scene/mtl.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <sstream>

#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/textures.hpp"
#include "host_tools/scene/tinyobj.hpp"

namespace torolux {
namespace {

/// What the check alone knows of a material.
struct Checked {
  std::string name;
  Place place;
  bool has_kd = false, has_ni = false, has_ns = false;
  TextureUse texture{};
};

/// The library as it may be handed on: known statements with good values, materials named 0, 1, ...
struct CheckedLibrary {
  std::vector<Checked> materials;
  std::string text;
};

bool among(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Checks `count` numbers >= 0 and writes them in full. One number stands for three, as the format has it.
void check_values(const Statement& statement, std::size_t count, const Place& place, CheckedLibrary& library) {
  const std::vector<std::string_view> words = statement.arguments();
  if (!words.empty() && among(words[0], {"spectral", "xyz"}))
    refuse(place, std::string(statement.keyword()) + " as a spectrum or in XYZ is not read; give red, green and blue");
  if (words.size() != count && words.size() != 1)
    refuse(place, std::string(statement.keyword()) + " has " + std::to_string(words.size()) + " values; expected " +
                      std::to_string(count));
  library.text += statement.keyword();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view word = words[words.size() == 1 ? 0 : i];
    const double value = read_number(word, place);
    if (value < 0)
      refuse(place, std::string(statement.keyword()) + " is " + std::string(word) + "; it must not be negative");
    if (value > kMostCoordinate)
      refuse(place, std::string(statement.keyword()) + " is " + std::string(word) + "; at most 1e15 is allowed");
    library.text += ' ';
    library.text += word;
  }
  library.text += '\n';
}

void begin_material(const Statement& statement, const Place& place, CheckedLibrary& library) {
  const std::string name(statement.rest());
  if (name.empty()) refuse(place, "newmtl without a name");
  for (const Checked& other : library.materials)
    if (other.name == name)
      refuse(place, "material " + in_quotes(name) + " is defined a second time; first in line " +
                        std::to_string(other.place.line));
  library.text += "newmtl " + std::to_string(library.materials.size()) + "\n";
  library.materials.push_back({name, place});
}

void check_transparency(const Statement& statement, const Place& place, Notices& notices) {
  const std::vector<std::string_view> words = statement.arguments();
  if (words.empty()) return;
  const bool halo = words[0] == "-halo";
  if (halo && words.size() < 2) refuse(place, "d -halo without a value");
  const double value = read_number(words[halo ? 1 : 0], place);
  if (statement.keyword() == "d" ? value < 1 : value > 0)
    notices.note("transparency by d or Tr is not used; glass is illum 7", place);
}

void check_statement(const Statement& statement, const Place& place, CheckedLibrary& library, Notices& notices) {
  const std::string_view keyword = statement.keyword();
  if (keyword == "newmtl") return begin_material(statement, place, library);
  if (library.materials.empty()) refuse(place, in_quotes(keyword) + " before the first newmtl");
  if (among(keyword, {"Kd", "Ks", "Ke", "Tf"})) {
    check_values(statement, 3, place, library);
    library.materials.back().has_kd |= keyword == "Kd";
  } else if (among(keyword, {"Ni", "Ns"})) {
    check_values(statement, 1, place, library);
    library.materials.back().has_ni |= keyword == "Ni";
    library.materials.back().has_ns |= keyword == "Ns";
  } else if (keyword == "illum") {
    const std::vector<std::string_view> words = statement.arguments();
    const double model = read_number(words.size() == 1 ? words[0] : std::string_view("none"), place);
    if (model != static_cast<int>(std::clamp(model, 0.0, 10.0)))
      refuse(place, "illum " + in_quotes(words[0]) + " is not an illumination model; they are 0 to 10");
    library.text += "illum " + std::to_string(static_cast<int>(model)) + "\n";
  } else if (among(keyword, {"d", "Tr"})) {
    check_transparency(statement, place, notices);
  } else if (keyword == "map_Kd") {
    library.materials.back().texture = read_texture_use(statement, place, notices);
  } else if (keyword.starts_with("map_") || among(keyword, {"bump", "norm", "disp", "decal", "refl"})) {
    notices.note("textures other than map_Kd are not used", place);
  } else if (!among(keyword, {"Ka", "sharpness", "Km", "Kr", "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor"})) {
    notices.note("statement " + in_quotes(keyword) + " is not known and not used", place);
  }
}

Vec3d triple(const tinyobj::real_t (&values)[3]) {
  return {values[0], values[1], values[2]};
}

bool is_zero(const Vec3d& v) {
  return v == Vec3d{0, 0, 0};
}

SceneMaterial mapped(const tinyobj::material_t& read, const Checked& checked, Notices& notices) {
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
    material.kind = SurfaceKind::mirror;
    material.specular = specular;
    if (!is_zero(triple(read.diffuse)) || !checked.texture.file.empty())
      notices.note("a mirror reflects by Ks alone; its Kd is not used", checked.place);
    return material;
  }
  material.diffuse = triple(read.diffuse);
  if (!checked.texture.file.empty() && is_zero(material.diffuse)) {
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
  if (read.illum == 4 || read.illum == 6 || read.illum == 9)
    notices.note("illum 4, 6 and 9 are read as diffuse; glass is illum 7", checked.place);
  return material;
}

}  // namespace

void import_mtl(std::string_view text, const std::string& file, std::vector<ImportedMaterial>& materials,
                Notices& notices) {
  CheckedLibrary library;
  StatementReader reader(text, file);
  for (Statement statement; reader.next(statement);)
    check_statement(statement, {file, statement.line}, library, notices);
  for (const Checked& checked : library.materials)
    for (const ImportedMaterial& other : materials)
      if (other.material.name == checked.name)
        refuse(checked.place, "material " + in_quotes(checked.name) + " is already defined at " + other.place.text());

  std::map<std::string, int> names;
  std::vector<tinyobj::material_t> read;
  std::istringstream stream(library.text);
  std::string warning;
  std::string error;
  tinyobj::LoadMtl(&names, &read, &stream, &warning, &error);
  // An empty library still gives tinyobjloader's own default material.
  for (std::size_t i = 0; i < library.materials.size(); ++i) {
    Checked& checked = library.materials[i];
    TextureUse& texture = checked.texture;
    if (!texture.file.empty())
      texture.file = (std::filesystem::path(file).parent_path() / texture.file).lexically_normal().string();
    materials.push_back({mapped(read.at(i), checked, notices), true, checked.place, texture});
  }
}

}  // namespace torolux
