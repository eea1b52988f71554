// SPDX-License-Identifier: MIT
// Proves: point and spot lights of a glTF file that are at one place light what is around as the sum of them. Their
// bodies are looked at, and irradiances estimated by rays to cells of them.
#include <algorithm>
#include <numbers>

#include "host_tools/scene/ray_cast.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/support/gltf_writer.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

/// turn: of a spot, from straight down, about x and then about z [degrees].
struct Light {
  std::string type;
  double intensity;
  double turn = 0, around = 0;
  Vec3d at{0.5, 0.5, 4};
};

/// Lights over a square floor of edge 1 in z = 0; their materials are named by their numbers.
Scene lit_by(const std::vector<Light>& lights) {
  GltfWriter file = gltf_square();
  constexpr double half_degree = std::numbers::pi / 360;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    file.json["extensions"]["KHR_lights_punctual"]["lights"].push_back(
        {{"type", light.type}, {"name", std::to_string(i)}, {"intensity", light.intensity}});
    const double s = std::sin(light.turn * half_degree);
    const double c = std::cos(light.turn * half_degree);
    const double sz = std::sin(light.around * half_degree);
    const double cz = std::cos(light.around * half_degree);
    file.node({{"translation", light.at},
               {"rotation", {s * cz, s * sz, c * sz, c * cz}},
               {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  }
  const std::string json = file.gltf();
  MemoryFiles files({{"a.gltf", json}, {"a.bin", file.bytes()}});
  return load_scene_from(files, "a.gltf", {});
}

/// On a plane that faces up, by light that comes straight from the lights [W/m^2].
double irradiance(const Scene& scene, const Vec3d& point) {
  constexpr int cells = 12;  // along an edge
  double sum = 0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const double radiance = scene.materials[scene.triangles[t].material].emission[0];
    if (!(radiance > 0)) continue;
    const auto& corner = scene.triangles[t].position;
    const Vec3d u = vec::subtract(scene.positions[corner[1]], scene.positions[corner[0]]);
    const Vec3d v = vec::subtract(scene.positions[corner[2]], scene.positions[corner[0]]);
    const Vec3d normal = front_normal(scene, t);
    for (int cell = 0; cell < cells * cells; ++cell) {
      // Upright cells and those that stand on their heads, by their middles.
      const int row = static_cast<int>(std::sqrt(cell));
      const int column = cell - row * row;
      const double a = (cells - 1 - row + (column % 2 == 0 ? 1.0 : 2.0) / 3) / cells;
      const double b = (column / 2 + (column % 2 == 0 ? 1.0 : 2.0) / 3) / cells;
      const Vec3d to =
          vec::subtract(vec::add(scene.positions[corner[0]], vec::add(vec::scale(u, a), vec::scale(v, b))), point);
      const double square = vec::dot(to, to);
      const double cosines = to[2] * -vec::dot(normal, to) / square;
      if (!(cosines > 0) || !(to[2] > 0)) continue;
      const auto hit = cast_ray(scene, point, to);
      if (!hit || hit->triangle == t || hit->distance > 1 - 1e-9)
        sum += radiance * cosines / square * area(scene, t) / (cells * cells);
    }
  }
  return sum;
}

const std::vector<Vec3d> kFloor{{0.5, 0.5, 0.01}, {1.7, 0.2, 0.01}, {-2, 3, 0.01}, {0.5, -4, 0.01}, {9, 0.5, 0.01}};

void expect_sum(const std::vector<Light>& lights, double tolerance) {
  const Scene all = lit_by(lights);
  for (const Vec3d& point : kFloor) {
    double sum = 0;
    for (const Light& light : lights) sum += irradiance(lit_by({light}), point);
    EXPECT_NEAR(irradiance(all, point) / sum, 1, tolerance) << point[0] << " " << point[1];
  }
}

/// By materials' numbers: radiance times area.
std::vector<double> powers(const Scene& scene) {
  std::vector<double> sums(scene.materials.size());
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const std::uint32_t m = scene.triangles[t].material;
    sums[m] += scene.materials[m].emission[0] * area(scene, t);
  }
  return sums;
}

/// Corners of what emits by a material's number.
std::vector<Vec3d> corners(const Scene& scene, std::size_t material) {
  std::vector<Vec3d> all;
  for (const SceneTriangle& triangle : scene.triangles)
    for (const std::uint32_t p : triangle.position)
      if (triangle.material == material) all.push_back(scene.positions[p]);
  return all;
}

/// No body has a corner before a disc's plane: none is hidden by another, and none is cut.
void expect_behind_discs(const Scene& scene) {
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const std::uint32_t disc = scene.triangles[t].material;
    if (!emits(scene.materials[disc]) || corners(scene, disc).size() != 18) continue;
    const Vec3d on = scene.positions[scene.triangles[t].position[0]];
    for (std::size_t other = 0; other < scene.materials.size(); ++other) {
      if (other == disc || !emits(scene.materials[other])) continue;
      for (const Vec3d& corner : corners(scene, other))
        EXPECT_LT(vec::dot(vec::subtract(corner, on), front_normal(scene, t)), 1e-9) << disc << " " << other;
    }
  }
}

TEST(GltfLightsSum, OneAloneGivesWhatItsIntensitySays) {
  for (const Vec3d& point : kFloor) {
    const Vec3d to = vec::subtract({0.5, 0.5, 4}, point);
    const double square = vec::dot(to, to);
    const double cosine = to[2] / std::sqrt(square);
    EXPECT_NEAR(irradiance(lit_by({{"spot", 3}}), point) / (3 * cosine * cosine / square), 1, 1e-4);
    // An icosahedron is not equally large from all sides.
    EXPECT_NEAR(irradiance(lit_by({{"point", 3}}), point) / (3 * cosine / square), 1, 0.06);
  }
}

TEST(GltfLightsSum, OfAPointAndASpot) {
  for (const double turn : {0.0, 40.0, 90.0}) expect_sum({{"point", 3}, {"spot", 3, turn}}, 0.01);
  expect_sum({{"spot", 1e-4}, {"point", 3}}, 0.01);
  expect_sum({{"spot", 3}, {"point", 1e-4}}, 0.01);
}

TEST(GltfLightsSum, OfSpotsThatTurnFromEachOther) {
  for (const double turn : {0.01, 0.5, 1.2, 4.5, 5.0, 30.0, 75.0, 150.0, 180.0}) {
    SCOPED_TRACE(turn);
    expect_sum({{"spot", 3}, {"spot", 3e-4, turn}}, 0.01);
    expect_sum({{"spot", 3}, {"spot", 5, turn, 20}}, 0.01);
  }
}

TEST(GltfLightsSum, OfManyAtOnePlace) {
  std::vector<Light> lights{{"point", 2}};
  for (int i = 0; i < 8; ++i) lights.push_back({"spot", 1.0 + i, 20.0 + 20 * (i % 3), 45.0 * i});
  lights.push_back({"spot", 4});
  expect_sum(lights, 0.01);
  lights.erase(lights.begin());
  expect_sum(lights, 0.01);
}

TEST(GltfLightsBodies, AreNotCutAndHaveTheirPower) {
  const std::vector<Light> lights{{"spot", 1}, {"point", 2}, {"spot", 3, 30}, {"spot", 4, 6, 90}, {"spot", 5, 180}};
  for (std::size_t count = 1; count <= lights.size(); ++count) {
    for (std::size_t first = 0; first + count <= lights.size(); ++first) {
      const auto from = lights.begin() + static_cast<std::ptrdiff_t>(first);
      const std::vector<Light> some(from, from + static_cast<std::ptrdiff_t>(count));
      const Scene scene = lit_by(some);
      expect_behind_discs(scene);
      const std::vector<double> sums = powers(scene);
      for (std::size_t i = 0; i < some.size(); ++i) {
        const auto named = std::ranges::find(scene.materials, std::to_string(i), &SceneMaterial::name);
        ASSERT_NE(named, scene.materials.end());
        const double share = some[i].type == "point" ? 0.25 : 1;
        EXPECT_NEAR(share * sums[static_cast<std::size_t>(named - scene.materials.begin())] / some[i].intensity, 1,
                    1e-6);
      }
      EXPECT_THAT(scene.warnings, Not(Contains(HasSubstr("hardly turn"))));
    }
  }
}

// Each place keeps to its half of the way to the next.
TEST(GltfLightsBodies, OfPlacesThatAreNearDoNotReachIntoEachOther) {
  for (const double way : {0.0008, 0.002}) {
    const Vec3d there{0.5 + way, 0.5, 4};
    const std::vector<Light> lights{{"point", 2},
                                    {"spot", 3, 90, 90},
                                    {"spot", 1, 90, -90},
                                    {"point", 2, 0, 0, there},
                                    {"spot", 3, 90, 90, there},
                                    {"spot", 1, 90, -90, there}};
    const Scene scene = lit_by(lights);
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
      if (!emits(scene.materials[m])) continue;
      const double middle = lights.at(std::stoul(scene.materials[m].name)).at[0];
      for (const Vec3d& corner : corners(scene, m))
        EXPECT_LT(vec::length(vec::subtract(corner, {middle, 0.5, 4})), way / 2) << way;
    }
    std::vector<double> sums = powers(scene);
    std::ranges::sort(sums);
    ASSERT_EQ(sums.size(), 7U);
    const std::vector<double> expected{0, 1, 1, 3, 3, 8, 8};
    for (std::size_t i = 1; i < sums.size(); ++i) EXPECT_NEAR(sums[i] / expected[i], 1, 1e-5) << way;
  }
}

TEST(GltfLightsBodies, OfSpotsThatHardlyTurnFromEachOtherAreOneWhichIsTold) {
  const Scene scene = lit_by({{"spot", 3}, {"spot", 1, 0.8}, {"spot", 2, 0.4, 90}});
  EXPECT_EQ(scene.triangles.size(), 2U + 6);
  const std::vector<double> sums = powers(scene);
  EXPECT_NEAR(*std::ranges::max_element(sums), 6, 1e-5);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("hardly turn from each other")));
  EXPECT_THAT(lit_by({{"spot", 3}, {"spot", 1, 0.01}}).warnings, Not(Contains(HasSubstr("hardly turn"))));
}

}  // namespace
}  // namespace torolux
