// SPDX-License-Identifier: MIT
// One path at a time, from the eye or from a point on a surface. Each pixel has two independent streams of random
// numbers: their difference is the noise.
#include "tests/references/path_tracer.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>

#include "tests/references/distant_light.hpp"
#include "tests/references/eye.hpp"
#include "tests/references/light_paths.hpp"
#include "tests/references/panes.hpp"
#include "tests/references/scattering.hpp"

namespace torolux::references {
namespace {

/// Tries for a caustic, so many a side of the square that their directions come from.
constexpr unsigned kTriesAside = 6;

/// One light path, followed from the eye.
class Path {
 public:
  /// caustics: how those are found that light_paths.hpp describes. tries: for tries alone, so that the path is the same
  /// with them and without.
  Path(const World& world, LightFinding finding, Caustics caustics, Samples& samples, Samples& tries)
      : world_(world), finding_(finding), caustics_(caustics), samples_(samples), tries_(tries) {
    if (world.sky()) far_.emplace(*world.sky());
  }

  /// A camera ray.
  Colour along(const Vec& origin, const Vec& direction) {
    origin_ = origin;
    direction_ = direction;
    follow();
    return light_;
  }

  /// From a white diffuse surface.
  Colour from(const Hit& hit) {
    direction_ = hit.front ? Vec(-world_.triangles()[hit.triangle].normal) : world_.triangles()[hit.triangle].normal;
    if (scatter(hit, Colour::Ones(), Colour::Zero(), 0) && survives()) follow();
    return light_;
  }

 private:
  void follow() {
    for (;;) {
      const auto hit = world_.closest(origin_, direction_, leaving_);
      if (!hit) return see_sky();
      if (!found_otherwise()) meet_emitter(*hit);
      if (straight_) sees_diffuse_ = world_.material(*hit).model == Model::diffuse;
      if (!turn(*hit) || !survives()) return;
    }
  }

  /// Of an emitter's light: by paths from the light, or by tries.
  bool found_otherwise() const {
    return caustics_ == Caustics::from_light && density_ == 0 && (sees_diffuse_ || scatterings_ == 1);
  }

  /// Light that mirrors or glass bring from emitters to where this path scatters first. In view by way of mirrors or
  /// glass itself, it is not found from the light, and one direction would find a small lamp by luck alone.
  void try_for_caustics(const Hit& hit, const Reflection& reflection) {
    Colour sum = Colour::Zero();
    for (unsigned i = 0; i < kTriesAside * kTriesAside; ++i) {
      Path path(world_, finding_, caustics_, tries_, tries_);
      path.weight_ = weight_;
      path.radiance_scale_ = radiance_scale_;
      const double lobe = tries_.uniform();
      const double first = (i % kTriesAside + tries_.uniform()) / kTriesAside;
      const double second = (i / kTriesAside + tries_.uniform()) / kTriesAside;
      if (path.leave(hit, reflection, lobe, {first, second})) path.follow_to_emitter();
      sum += path.light_;
    }
    light_ += sum / (kTriesAside * kTriesAside);
  }

  /// By mirrors, glass and panes alone.
  void follow_to_emitter() {
    for (;;) {
      const auto hit = world_.closest(origin_, direction_, leaving_);
      if (!hit) return;
      if (density_ == 0) meet_emitter(*hit);
      const Model model = world_.material(*hit).model;
      if (model == Model::diffuse || model == Model::glossy || !turn(*hit) || !survives()) return;
    }
  }

  /// The path leaves the scene. Of surfaces that scatter, the sun has been asked for, and openings.
  void see_sky() {
    if (!far_) return;
    double share = 1;
    if (density_ > 0 && far_->has_openings() && finding_ != LightFinding::directions_only)
      share = finding_ == LightFinding::both ? power(density_, far_->opening_density(vertex_, direction_)) : 0;
    light_ += weight_ * radiance_scale_ * (density_ == 0 ? far_->sky_shown(direction_) : far_->sky(direction_)) * share;
    if (density_ == 0 || finding_ == LightFinding::directions_only)
      light_ += weight_ * radiance_scale_ * far_->sun(direction_);
  }

  void ask_sun(const Hit& hit, const Reflection& reflection) {
    if (!far_ || !far_->has_sun()) return;
    const double height = samples_.uniform();
    const Vec out = far_->to_sun({height, samples_.uniform()});
    const double cosine = reflection.cosine(out);
    if (cosine <= 0) return;
    const Vec origin = world_.leave(hit, out);
    const Vec beyond = origin + out * (4 * world_.size());
    const Colour through = passed(world_, origin, beyond, hit.triangle, kNoTriangle);
    light_ += weight_ * through * radiance_scale_ * reflection.value(out) * far_->sun_irradiance() * cosine;
  }

  /// The sky, by chance through an opening.
  void ask_openings(const Hit& hit, const Reflection& reflection, double pick, const std::array<double, 2>& place) {
    if (!far_ || !far_->has_openings()) return;
    const Vec out = far_->to_opening(hit.point, pick, place);
    const double cosine = reflection.cosine(out);
    const double density = far_->opening_density(hit.point, out);
    if (cosine <= 0 || density <= 0) return;
    const Vec origin = world_.leave(hit, out);
    const Colour through = passed(world_, origin, origin + out * (4 * world_.size()), hit.triangle, kNoTriangle);
    const double share = finding_ == LightFinding::both ? power(density, reflection.density(out)) : 1;
    light_ += weight_ * through * radiance_scale_ * reflection.value(out) * far_->sky(out) * (cosine / density * share);
  }

  bool turn(const Hit& hit) {
    const Material& material = world_.material(hit);
    switch (material.model) {
      case Model::mirror:
        weight_ *= material.specular;
        go(hit, mirror(direction_, world_.triangles()[hit.triangle].normal, world_.shading_normal(hit)));
        density_ = 0;
        return true;
      case Model::glass:
        cross_glass(hit, material);
        return true;
      case Model::pane:
        meet_pane(hit, material);
        return true;
      case Model::diffuse:
        return scatter(hit, world_.diffuse_at(hit), Colour::Zero(), 0);
      case Model::glossy:
        return scatter(hit, world_.diffuse_at(hit), material.specular, material.exponent);
    }
    return false;
  }

  /// By chance through it, unbent, or back. What passes is found by asking emitters, too: so nothing is changed by
  /// which that is weighed.
  void meet_pane(const Hit& hit, const Material& material) {
    const Vec& flat = world_.triangles()[hit.triangle].normal;
    const PaneParts parts = pane(direction_, flat, material);
    const double chance = parts.chance_to_reflect();
    if (samples_.uniform() < chance) {
      weight_ *= parts.reflected / chance;
      go(hit, mirror(direction_, flat, flat));
      density_ = 0;
    } else {
      weight_ *= parts.passed / (1 - chance);
      origin_ = world_.leave(hit, direction_);
      leaving_ = hit.triangle;
    }
  }

  void cross_glass(const Hit& hit, const Material& material) {
    const Vec& flat = world_.triangles()[hit.triangle].normal;
    const Vec round = world_.shading_normal(hit);
    const double eta = hit.front ? 1 / material.refractive_index : material.refractive_index;
    const GlassWays ways = glass(direction_, flat, round, eta);
    density_ = 0;
    if (samples_.uniform() < ways.reflectance) {
      go(hit, mirror(direction_, flat, round));
      return;
    }
    weight_ *= material.transmittance;
    radiance_scale_ *= eta * eta;  // radiance over the square of the refractive index is what a ray keeps
    go(hit, ways.refracted);
  }

  /// Light from emitters at a diffuse or glossy surface, and the way on. False: the path has ended.
  bool scatter(const Hit& hit, const Colour& diffuse, const Colour& specular, double exponent) {
    const Vec& front = world_.triangles()[hit.triangle].normal;
    const Reflection reflection(hit.front ? front : Vec(-front), mirror(direction_, front, world_.shading_normal(hit)),
                                diffuse, specular, exponent);
    const unsigned dimension = 1 + 3 * turns_;
    const auto [emitter, lobe] = samples_.pair(dimension);
    if (finding_ != LightFinding::directions_only) {
      ask_sun(hit, reflection);
      const std::array<double, 2> place = samples_.pair(dimension + 1);
      ask_emitters(hit, reflection, emitter, place);
      ask_openings(hit, reflection, emitter, place);
    }
    if (caustics_ == Caustics::from_light && !sees_diffuse_ && scatterings_ == 0) try_for_caustics(hit, reflection);
    return leave(hit, reflection, lobe, samples_.pair(dimension + 2));
  }

  /// False: the path has ended.
  bool leave(const Hit& hit, const Reflection& reflection, double lobe, const std::array<double, 2>& place) {
    const Vec out = reflection.sample(lobe, place);
    const double cosine = reflection.cosine(out);
    const double density = reflection.density(out);
    if (cosine <= 0 || density <= 0) return false;
    weight_ *= reflection.value(out) * (cosine / density);
    go(hit, out);
    density_ = density;
    ++scatterings_;
    return (weight_ > 0).any();
  }

  /// A point on an emitter, by chance.
  void ask_emitters(const Hit& hit, const Reflection& reflection, double pick, const std::array<double, 2>& place) {
    const double root = std::sqrt(place[0]);
    const double along = place[1];
    const EmitterChoice emitter = world_.pick_emitter(hit.point, pick);
    if (emitter.density == 0) return;
    const Triangle& triangle = world_.triangles()[emitter.triangle];
    const Hit target = world_.at(emitter.triangle, root * (1 - along), root * along, true);
    const Vec way = target.point - hit.point;
    const double distance2 = way.squaredNorm();
    if (!(distance2 > 0)) return;
    const Vec out = way / std::sqrt(distance2);
    const double cos_emitter = -out.dot(triangle.normal);
    const double cosine = reflection.cosine(out);
    if (cosine <= 0 || cos_emitter == 0 || (cos_emitter < 0 && !world_.shines_around(emitter.triangle))) return;
    const Vec origin = world_.leave(hit, out);
    const Colour through = passed(world_, origin, target.point, hit.triangle, emitter.triangle);
    if ((through == 0).all()) return;
    const double density = emitter.density * distance2 / std::fabs(cos_emitter);
    const double share = finding_ == LightFinding::both ? power(density, reflection.density(out)) : 1;
    light_ += weight_ * through * radiance_scale_ * reflection.value(out) *
              world_.emission_at({target.triangle, 0, 0, cos_emitter > 0, target.point}, -out) *
              (cosine / density * share);
  }

  /// What the emitter that the path has come upon adds.
  void meet_emitter(const Hit& hit) {
    const Colour emission =
        scatterings_ > 0 ? world_.emission_at(hit, -direction_) : world_.emission_seen(hit, -direction_);
    if ((emission == 0).all()) return;
    double share = 1;
    if (density_ > 0) {
      if (finding_ == LightFinding::emitters_only) return;  // asked for where the path was turned
      if (finding_ == LightFinding::both) {
        const double cosine = std::fabs(direction_.dot(world_.triangles()[hit.triangle].normal));
        const double distance2 = (hit.point - vertex_).squaredNorm();
        share = power(density_, world_.light_density(vertex_, hit) * distance2 / cosine);
      }
    }
    light_ += weight_ * radiance_scale_ * emission * share;
  }

  static double power(double mine, double other) {
    const double ratio = other / mine;
    return 1 / (1 + ratio * ratio);
  }

  void go(const Hit& hit, const Vec& direction) {
    straight_ = false;
    vertex_ = hit.point;
    origin_ = world_.leave(hit, direction);
    direction_ = direction;
    leaving_ = hit.triangle;
  }

  /// Russian roulette by the path's weight.
  bool survives() {
    constexpr unsigned kSure = 3;
    if (++turns_ <= kSure) return true;
    const double chance = std::min(0.97, weight_.maxCoeff());
    if (samples_.uniform() >= chance) return false;
    weight_ /= chance;
    return true;
  }

  const World& world_;
  LightFinding finding_;
  Caustics caustics_;
  Samples& samples_;
  Samples& tries_;
  std::optional<DistantLight> far_;
  unsigned scatterings_ = 0;   // since it left the eye
  bool straight_ = true;       // through panes alone, as light_paths.hpp sees
  bool sees_diffuse_ = false;  // the camera, where the path first turns
  Vec vertex_ = Vec::Zero();   // where the path was last turned
  Vec origin_ = Vec::Zero();   // the same, off the surface
  Vec direction_ = Vec::Zero();
  std::uint32_t leaving_ = kNoTriangle;
  Colour weight_ = Colour::Ones();
  double radiance_scale_ = 1;  // square of (index where the eye is / index where the path is)
  double density_ = 0;         // of the direction that the path came by; 0: the only one, or the camera's
  unsigned turns_ = 0;
  Colour light_ = Colour::Zero();
};

std::array<float, 3> to_pixel(const Colour& sum, double samples) {
  const Colour mean = sum / samples;
  return {static_cast<float>(mean[0]), static_cast<float>(mean[1]), static_cast<float>(mean[2])};
}

void add(const Picture& more, Picture& sum) {
  for (std::size_t pixel = 0; pixel < sum.pixels.size(); ++pixel) {
    for (std::size_t c = 0; c < 3; ++c) sum.pixels[pixel][c] += more.pixels[pixel][c];
  }
}

}  // namespace

Colour incident_over_pi(const World& world, const Hit& hit, LightFinding finding, Samples& samples) {
  return Path(world, finding, Caustics::from_eye, samples, samples).from(hit);
}

TracedPicture trace(const World& world, const Camera& camera, const TraceChoice& choice) {
  const Eye eye(camera, choice);
  TracedPicture result;
  for (Picture* picture : {&result.picture, &result.first_half, &result.second_half}) {
    *picture = {choice.width, choice.height, {}};
    picture->pixels.resize(std::size_t{choice.width} * choice.height);
  }
  const std::uint32_t half = choice.samples / 2;
  const auto trace_pixel = [&](std::uint32_t column, std::uint32_t row) {
    const std::size_t pixel = std::size_t{row} * choice.width + column;
    // A stream for each half, so that they are independent.
    const auto sum = [&](std::uint64_t which) {
      Samples samples(choice.seed, 2 * pixel + which);
      Samples tries(choice.seed, ~(2 * pixel + which));
      Colour light = Colour::Zero();
      for (std::uint32_t sample = 0; sample < half; ++sample) {
        samples.begin(sample);
        const auto [x, y] = samples.pair(0);
        Path path(world, choice.finding, choice.caustics, samples, tries);
        if (!eye.has_lens()) {
          light += path.along(eye.place(), eye.direction(column + x, row + y));
          continue;
        }
        const double turn = samples.uniform();
        const Eye::Ray ray = eye.ray(column + x, row + y, turn, samples.uniform());
        light += path.along(ray.origin, ray.direction);
      }
      return light;
    };
    const Colour first = sum(0);
    const Colour second = sum(1);
    result.first_half.pixels[pixel] = to_pixel(first, half);
    result.second_half.pixels[pixel] = to_pixel(second, half);
    result.picture.pixels[pixel] = to_pixel(first + second, 2.0 * half);
  };
  std::atomic<std::uint32_t> next_row = 0;
  const auto work = [&] {
    for (std::uint32_t row = next_row++; row < choice.height; row = next_row++) {
      for (std::uint32_t column = 0; column < choice.width; ++column) trace_pixel(column, row);
    }
  };
  std::vector<std::jthread> helpers;
  const unsigned threads = choice.threads > 0 ? choice.threads : std::max(1U, std::thread::hardware_concurrency());
  for (unsigned i = 1; i < threads; ++i) helpers.emplace_back(work);
  work();
  helpers.clear();
  if (choice.caustics == Caustics::from_light) {
    const TracedPicture more = trace_caustics(world, camera, choice);
    add(more.picture, result.picture);
    add(more.first_half, result.first_half);
    add(more.second_half, result.second_half);
  }
  return result;
}

}  // namespace torolux::references
