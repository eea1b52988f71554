// SPDX-License-Identifier: MIT
// Each wall has its own number of paths, more where few of them find light. Leaves for each wall: the error of its
// worst channel, and the reference's noise there.
#include "tests/support/mirror_block.hpp"

#include <cmath>

namespace torolux::test {
namespace {

struct Wall {
  std::string_view name;
  std::size_t quad;  ///< in the order of the scene file
  std::uint32_t
      paths;  ///< more where little light falls and much of that by way of the mirror, where few paths find it
};
constexpr std::array<Wall, 10> kWalls{{
    {"floor", 0, 500'000},
    {"ceiling", 2, 2'000'000},
    {"back", 3, 300'000},
    {"green wall", 4, 200'000},
    {"red wall", 5, 300'000},
    {"short block, top", 6, 100'000},
    {"short block, towards the red wall", 7, 150'000},
    {"short block, front", 8, 400'000},
    {"short block, towards the green wall", 9, 150'000},
    {"short block, back", 10, 100'000},
}};

std::vector<std::uint32_t> quad_of_triangle(std::size_t triangles) {
  std::vector<std::uint32_t> quads(triangles);
  for (std::uint32_t t = 0; t < quads.size(); ++t) quads[t] = t / 2;
  return quads;
}

}  // namespace

std::filesystem::path mirror_block_scene() {
  return data_dir() / "scenes" / "cornell_mirror";
}

std::vector<GroupLight> traced_mirror_block(double effort) {
  const Scene scene = load_scene(mirror_block_scene(), {});
  std::vector<std::uint32_t> paths(scene.triangles.size() / 2);
  for (const Wall& wall : kWalls) paths[wall.quad] = static_cast<std::uint32_t>(effort * wall.paths);
  return traced_light(references::World(scene, false), make_mesh(scene, {}), quad_of_triangle(scene.triangles.size()),
                      paths);
}

std::vector<WallError> wall_errors(const SolvedScene& solved, std::span<const GroupLight> traced) {
  const auto light = solved_light(solved, quad_of_triangle(solved.scene.triangles.size()));
  std::vector<WallError> errors;
  for (const Wall& wall : kWalls) {
    WallError worst{wall.name, wall.name.starts_with("short block"), 0, 0};
    const GroupLight& should = traced[wall.quad];
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = light[wall.quad].flux[c] / should.flux[c] - 1;
      if (std::fabs(error) >= std::fabs(worst.error)) {
        worst.error = error;
        worst.noise = should.relative_noise(c);
      }
    }
    errors.push_back(worst);
  }
  return errors;
}

}  // namespace torolux::test
