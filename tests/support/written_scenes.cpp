// SPDX-License-Identifier: MIT
// Writes scenes in other formats, so that each of them can be read again and be the same.
#include "tests/support/written_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/support/gltf_writer.hpp"

namespace torolux {
namespace {

using Json = nlohmann::json;

Json gltf_material(const SceneMaterial& material) {
  const double strength = std::max(vec::largest(material.emission), 1.0);
  return {{"name", material.name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {material.diffuse[0], material.diffuse[1], material.diffuse[2], 1}},
            {"metallicFactor", 0}}},
          {"emissiveFactor", vec::scale(material.emission, 1 / strength)},
          {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", strength}}}}}};
}

/// The chromaticity and luminance that linear_colour makes this colour of: found by steps, so that it owes nothing to
/// the matrices.
std::string mgf_colour(const Vec3d& rgb, const char* entity, double units) {
  Chromaticity at;
  for (double step = 0.05; step > 1e-14; step *= 0.7) {
    const auto distance = [&](const Chromaticity& xy) {
      const LinearColour is = linear_colour(xy, luminance(rgb));
      return vec::length(vec::subtract(is.rgb, rgb)) + (is.clipped ? 1 : 0);
    };
    bool better = true;
    while (better) {
      better = false;
      for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
        const Chromaticity next{at.x + dx * step, at.y + dy * step};
        if (distance(next) < distance(at)) {
          at = next;
          better = true;
        }
      }
    }
  }
  std::ostringstream text;
  text << std::setprecision(17) << "c\ncxy " << at.x << " " << at.y << "\n"
       << entity << " " << luminance(rgb) * units << "\n";
  return text.str();
}

}  // namespace

std::string as_glb(const Scene& scene) {
  GltfWriter file;
  file.json["extensionsUsed"] = {"KHR_materials_emissive_strength"};
  for (const SceneMaterial& material : scene.materials) file.json["materials"].push_back(gltf_material(material));
  std::vector<float> positions;
  Json primitives;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const SceneTriangle& triangle = scene.triangles[t];
    for (const std::uint32_t p : triangle.position)
      for (const double x : scene.positions[p]) positions.push_back(static_cast<float>(x));
    if (t + 1 < scene.triangles.size() && scene.triangles[t + 1].material == triangle.material) continue;
    primitives.push_back(
        {{"attributes", {{"POSITION", file.floats(positions, "VEC3")}}}, {"material", triangle.material}});
    positions.clear();
  }
  file.json["meshes"] = {{{"primitives", primitives}}};
  const Camera& camera = *scene.camera;
  file.json["cameras"] = {
      {{"type", "perspective"},
       {"perspective", {{"yfov", camera.field_of_view_degrees * 0.017453292519943295}, {"znear", 1}}}}};
  file.node({{"mesh", 0}});
  // It looks along +z, a half turn about y from how cameras of glTF look.
  file.node({{"camera", 0}, {"rotation", {0, 1, 0, 0}}, {"translation", camera.eye}});
  return file.glb();
}

std::string as_mgf(const Scene& scene) {
  std::ostringstream text;
  text << std::setprecision(17);
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    const Vec3d& p = scene.positions[i];
    text << "v v" << i << " =\np " << p[0] << " " << p[1] << " " << p[2] << "\n";
  }
  for (const SceneMaterial& m : scene.materials) {
    text << "m " << m.name << " =\nsides 1\n";
    if (vec::largest(m.diffuse) > 0) text << mgf_colour(m.diffuse, "rd", 1);
    if (vec::largest(m.emission) > 0) text << mgf_colour(m.emission, "ed", 179 * 3.14159265358979323846);
  }
  for (const SceneTriangle& t : scene.triangles)
    text << "m " << scene.materials[t.material].name << "\nf v" << t.position[0] << " v" << t.position[1] << " v"
         << t.position[2] << "\n";
  return text.str();
}

}  // namespace torolux
