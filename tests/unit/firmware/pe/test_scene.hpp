// SPDX-License-Identifier: MIT
// Small scenes for tests of the firmware.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "firmware/pe/scene.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::test {

struct TestPolygon {
  std::array<protocol::Vec3f, 3> corner;
  std::uint16_t material = 0;
  std::uint8_t sides = protocol::kFrontPresent;
  std::uint8_t patch_level = 0;
  std::uint8_t element_level = 0;
};

struct TestScene {
  std::vector<TestPolygon> polygons;
  std::vector<protocol::Material> materials;
  std::vector<protocol::Emitter> emitters;  ///< empty: no shadow rays
  std::array<std::uint32_t, 3> cells{1, 1, 1};
  protocol::Vec3f size{1, 1, 1};  ///< of the object space
  std::uint32_t pes = 1;
  std::uint32_t seed = 1;
  std::uint32_t bounces = 32;
  std::uint32_t hemicube_size = 4;
  bool groups = false;  ///< subspaces' lists in groups, and not in the order of numbers
  std::uint32_t points = 1;
  float points_per_quantum = 1;
  float pixel_scale = 0x1p20F;
  float least_weight = 0;
  std::uint32_t apart = protocol::kDirect;  ///< as protocol::StageLayout
  float dense_shot = 0x1p100F;              ///< likewise; no shot is
  float mean_radiosity = 1;                 ///< likewise
  std::uint32_t gathers_emission = 0;       ///< likewise
  std::uint32_t layers = 0;
  bool stop_everywhere = false;  ///< rays stop in every cell, not only where a polygon stands
  bool copy_all = false;         ///< every PE holds all of these cells
  bool keep_surfaces = false;    ///< ray tracing stage: each polygon's surface is at one PE alone, by its number
  std::uint32_t open_batches = protocol::kMostOpenBatches;
  std::uint32_t credits_kept = 16;

  std::uint16_t pe_of(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return static_cast<std::uint16_t>((x + 3 * y + 5 * z) % pes);
  }
  std::array<std::uint32_t, 3> cell_of(const std::array<double, 3>& point) const;
  /// Code of the cell that holds a point.
  protocol::CellCode place_of(const glm::vec3& point) const {
    const auto cell = cell_of({point.x, point.y, point.z});
    return protocol::cell_code(cell[0], cell[1], cell[2]);
  }
};

/// Of a triangle.
float area_of(const std::array<protocol::Vec3f, 3>& corner);

protocol::Material diffuse_material(float reflectance, float emission = 0);
protocol::Material mirror_material(float reflectance);
protocol::Material glass_material(float refractive_index, float transmittance = 1);
/// transmittance: on one way between the faces.
protocol::Material pane_material(float refractive_index, float transmittance = 1);
protocol::Material glossy_material(float diffuse, float specular, float exponent);

/// Makes all polygons of one material the scene's emitters, each chosen with the same chance.
void aim_at(TestScene& scene, std::uint16_t material);

/// Two triangles for each of n * n cells of a wall. a, b: edge vectors; the front is where a x b points.
void add_wall(TestScene& scene, const protocol::Vec3f& corner, const protocol::Vec3f& a, const protocol::Vec3f& b,
              std::uint32_t n, std::uint16_t material);
/// Six walls of the box [low, high], fronts inside.
void add_room(TestScene& scene, const protocol::Vec3f& low, const protocol::Vec3f& high, std::uint32_t n,
              std::uint16_t material);
/// A closed ball of 2 * n * n facets around the latitudes, fronts outside or inside.
void add_ball(TestScene& scene, const protocol::Vec3f& centre, float radius, std::uint32_t n, std::uint16_t material,
              bool front_outside);

}  // namespace torolux::test
