// SPDX-License-Identifier: MIT
// A path goes from an emitter over a few diffuse surfaces, through mirrors, glass and lobes on its way. Emitted and
// reflected light are counted apart; sums become means over the paths.
#include "host_tools/setup/path_sample.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Diffuse surfaces on a path: what is left of the light after more is little.
constexpr std::uint32_t kReflections = 5;
/// Records of reflected light for each of emitted light that carries as much: records grow fainter, so there are more.
/// At `normal` 2.0 (two_mirrors), 3.1 (cornell_spheres), 3.7 (cornell_box), 6.0 (interior), 6.8 (glossy_floor) and 7.7
/// (a room with 1,000 boxes), by the rounds that predict.cpp goes through.
constexpr double kReflectedRecords = 5;

double mean_of(const Vec3d& colour) {
  return (colour[0] + colour[1] + colour[2]) / 3;
}

/// Light on its way: where it begins, the normal there, and its flux.
struct Start {
  Vec3d place, normal;
  double flux;
};

class Follower {
 public:
  /// records: made for one unit of flux.
  Follower(const Scene& scene, const Mesh& mesh, const Placement& placement, std::uint32_t bounces, PathSample& sample,
           double records, Heat* heat)
      : scene_(scene),
        mesh_(mesh),
        sample_(sample),
        cost_(mesh, placement, sample, heat),
        bounces_(bounces),
        records_(records) {}

  /// To the next surfaces: what one of them reflects diffusely. Nothing: the path has met none.
  std::optional<Start> follow(const Start& start, Chance& chance) {
    ++paths_;
    flux_ += start.flux;
    Path path{{start.place, chance.cosine_direction(start.normal)}, cost_.cell_of(start.place), start.flux};
    cost_.begin(records_ * start.flux, path.cell);
    std::optional<Start> chosen;
    double fallen = 0;
    for (std::uint32_t bounce = 0; bounce < bounces_; ++bounce) {
      const Meeting met = cost_.walk(path.ray, path.cell);
      if (met.triangle == nullptr) {
        sample_.escaped += 1;
        break;
      }
      path.ray.origin = vec::add(path.ray.origin, vec::scale(path.ray.direction, met.t));
      const Vec3d flat = normal_of(*met.triangle);
      const bool front = vec::dot(flat, path.ray.direction) < 0;
      const Vec3d normal = front ? flat : vec::scale(flat, -1);
      const SceneMaterial& material = scene_.materials[met.triangle->material];
      if (material.kind != SurfaceKind::diffuse) {
        turn(path, normal, material);
        continue;
      }
      sample_.hits[static_cast<std::size_t>(met.triangle - mesh_.triangles.data())][front ? 0 : 1] += path.flux;
      const std::uint32_t patch = cost_.deposit(met);
      fallen += path.flux;
      if (chance.uniform() * fallen < path.flux)
        chosen = Start{path.ray.origin, normal, mesh_.patches[patch].mean_reflectance()};
      if (!is_glossy(material) || !go_on(path, normal, material, patch, chance)) break;
    }
    if (chosen) chosen->flux *= fallen;
    return chosen;
  }

  /// From sums to means.
  void finish() {
    for (PathWork& pe : sample_.of_pe) pe *= 1 / std::max(1.0, paths_);
    sample_.anywhere *= 1 / std::max(1.0, paths_);
    for (auto& sides : sample_.hits) {
      for (double& hits : sides) hits /= flux_ > 0 ? flux_ : 1;
    }
    sample_.escaped /= std::max(1.0, paths_);
  }

 private:
  struct Path {
    SampleRay ray;
    PathCost::Cell cell;
    double flux;
  };

  void turn(Path& path, const Vec3d& normal, const SceneMaterial& material) {
    cost_.work().turns += 1;
    if (material.kind == SurfaceKind::mirror) {
      path.ray.direction = mirrored(path.ray.direction, normal);
      path.flux *= mean_of(material.specular);
    } else {
      path.flux *= mean_of(material.transmittance);
    }
  }

  /// By the lobe, as firmware/pe/radiosity.cpp has it: by chance, from the patch's owner. False: it ends.
  bool go_on(Path& path, const Vec3d& normal, const SceneMaterial& material, std::uint32_t patch, Chance& chance) {
    const Vec3d out = chance.lobe_direction(mirrored(path.ray.direction, normal), material.exponent);
    const double weight = (material.exponent + 2) / (material.exponent + 1);
    const double most = std::min(1.0, weight * vec::largest(material.specular));
    if (!(chance.uniform() < most * vec::dot(out, normal))) return false;
    cost_.work().turns += 1;
    cost_.go_to_patch(patch);
    path.ray.direction = out;
    path.flux *= weight * mean_of(material.specular) / most;
    return true;
  }

  const Scene& scene_;
  const Mesh& mesh_;
  PathSample& sample_;
  PathCost cost_;
  std::uint32_t bounces_;
  double records_;
  double paths_ = 0;
  double flux_ = 0;
};

/// Normal of the side from which light leaves; of a measured lamp one or the other by its flux.
Vec3d side_that_shines(const Scene& scene, const MeshTriangle& triangle, Chance& chance) {
  const Vec3d normal = normal_of(triangle);
  const std::uint32_t lamp = scene.materials[triangle.material].lamp;
  if (lamp == kNoMeasuredLamp || chance.uniform() < scene.lamps[lamp].share[0]) return normal;
  return vec::scale(normal, -1);
}

}  // namespace

LightSample sample_light(const Scene& scene, const Mesh& mesh, const Placement& placement, std::uint32_t bounces,
                         std::uint32_t count, Heat* heat) {
  LightSample light;
  Follower emitted(scene, mesh, placement, bounces, light.emitted, 1, heat);
  Follower reflected(scene, mesh, placement, bounces, light.reflected, kReflectedRecords, heat);
  const EmitterPoints emitters(scene, mesh);
  if (emitters.empty()) return light;
  Chance chance;
  for (std::uint32_t i = 0; i < count; ++i) {
    const EmitterPoints::Point point = emitters.point(chance);
    std::optional<Start> at = Start{point.place, side_that_shines(scene, *point.triangle, chance), 1};
    for (std::uint32_t reflection = 0; at && reflection <= kReflections; ++reflection) {
      at = (reflection == 0 ? emitted : reflected).follow(*at, chance);
    }
  }
  emitted.finish();
  reflected.finish();
  return light;
}

}  // namespace torolux
