// SPDX-License-Identifier: MIT
// Reads MGF's materials, and keeps those that are used.
#include "host_tools/scene/mgf_materials.hpp"

#include <algorithm>

namespace torolux {
namespace {

/// Each is compared with all others of its name.
constexpr std::size_t kMostAlike = 10'000;

bool are_alike(const std::vector<MaterialFault>& some, const std::vector<MaterialFault>& others) {
  return std::ranges::equal(some, others, [](const MaterialFault& a, const MaterialFault& b) {
    return a.value == b.value && a.place.text() == b.place.text() && a.message == b.message;
  });
}

/// Which value of a material a statement sets.
struct Field {
  MgfPortion MgfMaterial::*portion;
  MaterialValue value;
  bool rough;   ///< a roughness follows
  double most;  ///< a share, or light
  const char* form;
};

Field field_of(std::string_view keyword) {
  if (keyword == "rd") return {&MgfMaterial::diffuse, MaterialValue::diffuse, false, 1, "rd REFLECTANCE"};
  if (keyword == "td") return {&MgfMaterial::diffuse_through, MaterialValue::filter, false, 1, "td TRANSMITTANCE"};
  if (keyword == "ed")
    return {&MgfMaterial::emitted, MaterialValue::emission, false, kMostCoordinate, "ed LUMENS_PER_SQUARE_METRE"};
  // What is not read here is 0, as if there were none: it decides what kind of surface this is.
  if (keyword == "rs") return {&MgfMaterial::specular, MaterialValue::model, true, 1, "rs REFLECTANCE ROUGHNESS"};
  return {&MgfMaterial::specular_through, MaterialValue::filter, true, 1, "ts TRANSMITTANCE ROUGHNESS"};
}

/// Numbers of a statement, or why there are none.
std::optional<std::string> read(const MgfStatement& statement, std::span<double> values, const char* form) {
  if (statement.count() != values.size())
    return "'" + std::string(statement.keyword()) + "' has " + std::to_string(statement.count()) +
           " arguments; it is written " + form;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const ReadNumber number = parse_number(statement.word(i));
    if (!number.fault.empty()) return number.fault;
    values[i] = number.value;
  }
  return std::nullopt;
}

void set_portion(MgfMaterial& material, const MgfStatement& statement, const Chromaticity& colour) {
  const Field field = field_of(statement.keyword());
  std::array<double, 2> values{0, 0};
  auto fault = read(statement, std::span(values).first(field.rough ? 2 : 1), field.form);
  if (!fault && !(values[0] >= 0 && values[0] <= field.most))
    fault = "'" + std::string(statement.keyword()) + "' is " + std::string(statement.word(0)) + "; allowed are 0 to " +
            (field.most == 1 ? "1" : "1e15");
  if (!fault && !(values[1] >= 0)) fault = "the roughness is below 0";
  std::erase_if(material.faults, [&](const MaterialFault& f) { return f.value == field.value; });
  if (fault) {
    material.faults.push_back({field.value, statement.place(), *fault});
    values = {0, 0};
  }
  material.*field.portion = {values[0], colour, values[1]};
}

void set_index(MgfMaterial& material, const MgfStatement& statement) {
  std::array<double, 2> values{1, 0};
  auto fault = read(statement, values, "ir REAL IMAGINARY");
  if (!fault && !(values[0] > 0 && values[0] < 1e6)) fault = "the index of refraction must be above 0";
  std::erase_if(material.faults, [](const MaterialFault& f) { return f.value == MaterialValue::index; });
  if (fault) {
    material.faults.push_back({MaterialValue::index, statement.place(), *fault});
    values = {1, 0};
  }
  material.index = values[0];
  material.index_imaginary = values[1];
}

void set_sides(MgfMaterial& material, const MgfStatement& statement) {
  const bool right = statement.count() == 1 && (statement.word(0) == "1" || statement.word(0) == "2");
  if (!right) statement.refuse_with("'sides' is followed by 1 or 2");
  material.one_sided = statement.word(0) == "1";
}

}  // namespace

bool MgfMaterials::knows(std::string_view keyword) {
  constexpr std::array<std::string_view, 8> known{"m", "sides", "rd", "td", "ed", "rs", "ts", "ir"};
  return std::ranges::find(known, keyword) != known.end();
}

void MgfMaterials::select(const MgfStatement& statement) {
  // A library may be missing: as with OBJ, a name that is only used may come from scene.toml.
  const bool only_named = statement.count() == 1;
  const bool unknown = only_named && materials_.define(statement.word(0));
  if (materials_.select(statement) || unknown) {
    materials_.current().place = statement.place();
    materials_.current().number.reset();
  }
  if (unknown) materials_.current().defined = false;
}

void MgfMaterials::handle(const MgfStatement& statement, const Chromaticity& colour) {
  if (statement.keyword() == "m") return select(statement);
  MgfMaterial& material = materials_.current();
  material.number.reset();
  material.defined = true;
  if (material.place.file.empty()) material.place = statement.place();
  if (statement.keyword() == "sides") {
    set_sides(material, statement);
  } else if (statement.keyword() == "ir") {
    set_index(material, statement);
  } else {
    set_portion(material, statement, colour);
  }
}

std::uint32_t MgfMaterials::added(ImportedMaterial material) {
  std::vector<std::uint32_t>& alike = by_name_[material.material.name];
  for (const std::uint32_t number : alike) {
    const ImportedMaterial& other = mesh_.materials[number];
    if (other.material == material.material && other.defined == material.defined &&
        are_alike(other.faults, material.faults))
      return number;
  }
  if (alike.size() == kMostAlike)
    refuse(material.place,
           "more than 10000 materials of one name: a statement repeats with other values each time; make "
           "arrays (-a) smaller");
  alike.push_back(static_cast<std::uint32_t>(mesh_.materials.size()));
  mesh_.materials.push_back(std::move(material));
  return alike.back();
}

std::uint32_t MgfMaterials::current(const MgfStatement& use) {
  MgfMaterial& material = materials_.current();
  if (!material.number) {
    if (material.place.file.empty()) material.place = use.place();
    const std::string name = materials_.name();
    material.number = added(imported_material(name.empty() ? "(none)" : name, material, notices_));
  }
  return *material.number;
}

std::uint32_t MgfMaterials::brighter(std::uint32_t number, double share) {
  ImportedMaterial material = mesh_.materials[number];
  for (double& channel : material.material.emission) channel *= share;
  return added(std::move(material));
}

}  // namespace torolux
