// SPDX-License-Identifier: MIT
// Each ray branches as it would on the PEs: Fresnel's shares at glass, a lobe by chance, a shadow ray, until the weight
// is too little. Sums become means over the rays that are sent.
#include "host_tools/setup/camera_sample.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Ways that may wait, as in a RayRecord.
constexpr std::size_t kMostWaiting = protocol::kMostBranches;

/// As candidates_of in firmware/pe/emitters.cpp.
double points_of_aim(std::size_t emitters) {
  return emitters <= 2 ? 1.0 : std::min(static_cast<double>(emitters) - 1, 16.0);
}

/// Fresnel's equations for unpolarised light. eta: index behind the surface over the one before it.
double fresnel(double cosine, double eta) {
  const double square = 1 - (1 - cosine * cosine) / (eta * eta);
  if (!(square > 0)) return 1;
  const double inside = std::sqrt(square);
  const double parallel = (eta * cosine - inside) / (eta * cosine + inside);
  const double across = (cosine - eta * inside) / (cosine + eta * inside);
  return (parallel * parallel + across * across) / 2;
}

class CameraFollower {
 public:
  CameraFollower(const Scene& scene, const Mesh& mesh, const Placement& placement, const CameraSampleChoice& choice,
                 PathSample& sample, Heat* heat)
      : scene_(scene), choice_(choice), sample_(sample), cost_(mesh, placement, sample, heat), emitters_(scene, mesh) {}

  void follow(const SampleRay& ray, const PathCost::Cell& cell, Chance& chance) {
    cost_.begin(1, cell);
    waiting_.assign(1, {ray, cell, 1, 0});
    while (!waiting_.empty()) {
      Way way = waiting_.back();
      waiting_.pop_back();
      while (go(way, chance)) {
      }
    }
  }

 private:
  struct Way {
    SampleRay ray;
    PathCost::Cell cell;
    double weight;
    std::uint32_t bounce;
  };

  bool worth(double weight) const { return weight > 0 && weight >= choice_.least_weight; }

  /// One segment. False: the way ends with it.
  bool go(Way& way, Chance& chance) {
    const Meeting met = cost_.walk(way.ray, way.cell);
    if (met.triangle == nullptr) {
      sample_.escaped += 1;
      return false;
    }
    way.ray.origin = vec::add(way.ray.origin, vec::scale(way.ray.direction, met.t));
    const Vec3d flat = normal_of(*met.triangle);
    const bool front = vec::dot(flat, way.ray.direction) < 0;
    const Vec3d normal = front ? flat : vec::scale(flat, -1);
    const SceneMaterial& material = scene_.materials[met.triangle->material];
    if (material.kind != SurfaceKind::diffuse) return turn(way, normal, front, material, chance);
    cost_.see(met);
    return scatter(way, normal, material, chance);
  }

  bool turn(Way& way, const Vec3d& normal, bool front, const SceneMaterial& material, Chance& chance) {
    cost_.work().turns += 1;
    if (++way.bounce >= choice_.bounces) return false;
    const Vec3d reflected = mirrored(way.ray.direction, normal);
    if (material.kind == SurfaceKind::mirror) {
      way.weight *= vec::largest(material.specular);
      way.ray.direction = reflected;
      return worth(way.weight);
    }
    const double eta = front || material.thin ? material.refractive_index : 1 / material.refractive_index;
    const double face = fresnel(-vec::dot(normal, way.ray.direction), eta);
    const double share = material.thin ? 2 * face / (1 + face) : face;
    Way other = way;
    other.ray.direction = reflected;
    other.weight *= share;
    way.weight *= (1 - share) * vec::largest(material.transmittance);
    if (worth(other.weight) && worth(way.weight)) {
      if (waiting_.size() < kMostWaiting) {
        waiting_.push_back(other);
      } else if (chance.uniform() < share) {
        way = other;
      }
      return true;
    }
    if (worth(other.weight)) way = other;
    return worth(way.weight);
  }

  /// By the lobe, and towards an emitter, if shadow rays are asked for.
  bool scatter(Way& way, const Vec3d& normal, const SceneMaterial& material, Chance& chance) {
    Way lobe = way;
    const bool by_lobe = is_glossy(material) && choose_lobe(lobe, normal, material, chance);
    if (choice_.shadow_rays) cast_shadow(way, normal, chance);
    if (by_lobe) way = lobe;
    return by_lobe;
  }

  bool choose_lobe(Way& way, const Vec3d& normal, const SceneMaterial& material, Chance& chance) {
    cost_.work().turns += 1;
    if (++way.bounce >= choice_.bounces) return false;
    way.ray.direction = chance.lobe_direction(mirrored(way.ray.direction, normal), material.exponent);
    way.weight *= vec::largest(material.specular) * (material.exponent + 2) / (material.exponent + 1) *
                  vec::dot(way.ray.direction, normal);
    return worth(way.weight);
  }

  void cast_shadow(const Way& from, const Vec3d& normal, Chance& chance) {
    if (scene_.sky && scene_.sky->openings.empty()) look_for_sun(from, normal);
    if (emitters_.empty()) return look_for_sky(from, normal, chance);
    cost_.work().aims += points_of_aim(emitters_.count());
    const EmitterPoints::Point target = emitters_.point(chance);
    const Vec3d there = vec::subtract(target.place, from.ray.origin);
    if (!(vec::length(there) > 0) || !(vec::dot(there, normal) > 0)) return;
    const std::size_t side = vec::dot(there, normal_of(*target.triangle)) < 0 ? 0 : 1;
    if (!emits_from(scene_, scene_.materials[target.triangle->material], side, choice_.two_sided_lights)) return;
    PathCost::Cell cell = from.cell;
    const Meeting met = cost_.walk({from.ray.origin, vec::unit(there)}, cell);
    if (met.triangle == target.triangle) cost_.work().deposits += 1;
    if (met.triangle == nullptr) sample_.escaped += 1;
  }

  /// There is nothing else to aim at.
  void look_for_sky(const Way& from, const Vec3d& normal, Chance& chance) {
    cost_.work().aims += 1;
    PathCost::Cell cell = from.cell;
    const Meeting met = cost_.walk({from.ray.origin, chance.cosine_direction(normal)}, cell);
    if (met.triangle == nullptr) cost_.work().deposits += 1;
  }

  /// It has rays of its own. Where openings are named it shines on little, which is not counted.
  void look_for_sun(const Way& from, const Vec3d& normal) {
    const Sky& sky = *scene_.sky;
    if (!(vec::largest(sky.sun_irradiance) > 0) || !(vec::dot(sky.sun, normal) > 0)) return;
    PathCost::Cell cell = from.cell;
    const Meeting met = cost_.walk({from.ray.origin, sky.sun}, cell);
    if (met.triangle == nullptr) cost_.work().deposits += 1;
  }

  const Scene& scene_;
  CameraSampleChoice choice_;
  PathSample& sample_;
  PathCost cost_;
  EmitterPoints emitters_;
  std::vector<Way> waiting_;
};

}  // namespace

CameraSampleChoice camera_sample_choice(const Quality& quality, const MachineChoice& machine,
                                        const StageParameters& parameters) {
  CameraSampleChoice choice;
  choice.pixels = std::uint64_t{quality.width} * quality.height;
  choice.samples = quality.sample_places();
  choice.bounces = quality.bounces;
  choice.least_weight = double{parameters.least_weight} * quality.sample_places();
  choice.shadow_rays = quality.shadow_rays;
  choice.two_sided_lights = quality.two_sided_lights;
  choice.skip_empty_subspaces = machine.skip_empty_subspaces;
  return choice;
}

CameraSample sample_camera(const Scene& scene, const Mesh& mesh, const Placement& placement, const CameraRays& rays,
                           const CameraSampleChoice& choice, std::uint32_t count, Heat* heat) {
  CameraSample result;
  CameraFollower follower(scene, mesh, placement, choice, result.paths, heat);
  std::vector<bool> filled;
  for (const auto& polygons : placement.polygons_of_cell) filled.push_back(!polygons.empty());
  Chance chance;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double along = (i + chance.uniform()) / count;
    const auto pixel =
        std::min(static_cast<std::uint64_t>(along * static_cast<double>(choice.pixels)), choice.pixels - 1);
    const CameraRay ray = rays.ray(static_cast<std::uint32_t>(pixel), i % choice.samples);
    const auto start =
        first_subspace(placement.grid, ray.origin, ray.direction, choice.skip_empty_subspaces ? &filled : nullptr);
    if (!start) continue;
    result.sent += 1;
    follower.follow({to_double(ray.origin), to_double(ray.direction)}, placement.grid.cell(start->cell), chance);
  }
  for (PathWork& pe : result.paths.of_pe) pe *= 1 / std::max(1.0, result.sent);
  result.paths.anywhere *= 1 / std::max(1.0, result.sent);
  result.paths.escaped /= std::max(1.0, result.sent);
  result.sent /= count;
  return result;
}

}  // namespace torolux
