// SPDX-License-Identifier: MIT
// Hangs measured lamps in the mesh. Lamps of one file that hang alike share a material.
#include "host_tools/scene/mgf_lamp.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "host_tools/scene/number_among.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

/// Each is compared with all others.
constexpr std::size_t kMostLamps = 10'000;

}  // namespace

MgfLamp::MgfLamp(const MgfStatement& statement, const std::filesystem::path& folder, SceneFiles& files,
                 Notices& notices)
    : place_(statement.place()) {
  if (statement.count() == 0)
    statement.refuse_with("'ies' names no file; it is written ies FILE [-m FACTOR] [TRANSFORM]");
  name_ = statement.word(0);
  double factor = 1;
  if (statement.count() > 1 && statement.word(1) == "-m") {
    if (statement.count() == 2) statement.refuse_with("-m is followed by a factor of the lamp's intensities");
    factor = statement.number(2);
    if (!(factor > 0 && factor <= 1e12)) statement.refuse_with("-m: a factor above 0 and at most 1e12 is allowed");
    transform_ = 3;
  }
  const std::array<std::filesystem::path, 1> folders{folder};
  measured_ = load_measured_lamp(name_, folders, files, place_, notices);
  const SceneLamp level = hung_lamp(measured_, {0, 0, -1}, std::nullopt);
  const double area = opening_of(measured_, level, {0, 0, 0}, 1).area();
  const double radiance = factor * (measured_.flux[0] + measured_.flux[1]) / (std::numbers::pi * area);
  emission_ = {radiance, radiance, radiance};
}

void MgfLamp::hang(const MgfPlacement& placement, std::uint32_t line, std::size_t most, ImportedMesh& mesh) const {
  SceneLamp lamp = hung_lamp(measured_, {0, 0, -1}, std::nullopt);
  lamp.x = placement.direction(lamp.x);
  lamp.y = placement.direction(lamp.y);
  lamp.nadir = placement.direction(lamp.nadir);
  const ShapeMesh opening = opening_of(measured_, lamp, placement.point({0, 0, 0}), placement.scale);
  if (mesh.triangles.size() + opening.triangles.size() > most)
    refuse(place_, "more than " + std::to_string(most) + " triangles; make arrays (xf -a) smaller, or leave parts out");
  lamp.web = number_among(mesh.webs, measured_.web);
  const std::uint32_t material = material_of(lamp, {mesh.file, line}, mesh);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), opening.positions.begin(), opening.positions.end());
  for (const ShapeMesh::Triangle& triangle : opening.triangles) {
    ImportedTriangle out{triangle.position, {kNoNormal, kNoNormal, kNoNormal}, material, line};
    for (std::uint32_t& p : out.position) p += first;
    mesh.triangles.push_back(out);
  }
}

std::uint32_t MgfLamp::material_of(const SceneLamp& lamp, const Place& place, ImportedMesh& mesh) const {
  SceneMaterial material;
  material.name = name_;
  material.emission = emission_;
  material.lamp = number_among(mesh.lamps, lamp);
  const auto same = std::ranges::find(mesh.materials, material, &ImportedMaterial::material);
  if (same == mesh.materials.end()) {
    if (mesh.lamps.size() > kMostLamps)
      refuse(place_, "more than 10000 measured lamps that hang differently; make arrays (-a) smaller");
    mesh.materials.push_back({material, true, place});
    return static_cast<std::uint32_t>(mesh.materials.size() - 1);
  }
  return static_cast<std::uint32_t>(same - mesh.materials.begin());
}

}  // namespace torolux
