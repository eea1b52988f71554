// SPDX-License-Identifier: MIT
// What counts is light that a diffuse surface shows after a turn at mirror, glass or lobe. Paths come in fixed streams,
// added up in their order, so that threads never show.
#include "tests/references/light_paths.hpp"

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <thread>

#include "tests/references/eye.hpp"
#include "tests/references/panes.hpp"
#include "tests/references/scattering.hpp"

namespace torolux::references {
namespace {

/// Pictures are added up in a fixed order, whatever the threads.
constexpr std::uint32_t kStreamsOfHalf = 8;

using Sums = std::vector<Colour>;  // by pixel

/// One light path, followed from its emitter.
class LightPath {
 public:
  LightPath(const World& world, const Eye& eye, Samples& samples, Sums& sums)
      : world_(world), eye_(eye), samples_(samples), sums_(sums) {}

  void follow() {
    if (!leave_emitter()) return;
    for (bool by_way = false;;) {
      const auto hit = world_.closest(origin_, direction_, leaving_);
      if (!hit) return;
      const Material& material = world_.material(*hit);
      if (material.model == Model::pane) {
        by_way = !pass_pane(*hit, material) || by_way;
        if (!survives()) return;
        continue;
      }
      const bool specular = material.model == Model::mirror || material.model == Model::glass;
      if (!specular && !by_way) return;  // seen from the eye without luck
      by_way = true;
      if (!(specular ? pass(*hit, material) : scatter(*hit, material)) || !survives()) return;
    }
  }

 private:
  bool leave_emitter() {
    const auto& emitters = world_.emitters();
    double all = 0;
    for (const Emitter& emitter : emitters) all += emitter.power;
    const auto [pick, side] = samples_.pair(0);
    double rest = pick * all;
    const Emitter* chosen = nullptr;
    for (const Emitter& emitter : emitters) {
      chosen = &emitter;
      rest -= emitter.power;
      if (rest < 0) break;
    }
    if (chosen == nullptr) return false;
    const auto [square, along] = samples_.pair(1);
    const double root = std::sqrt(square);
    const bool both = world_.shines_around(chosen->triangle);
    const bool front = !both || side < 0.5;
    const Hit from = world_.at(chosen->triangle, root * (1 - along), root * along, front);
    const Triangle& triangle = world_.triangles()[chosen->triangle];
    const auto [height, turn] = samples_.pair(2);
    const Vec out = around(front ? triangle.normal : Vec(-triangle.normal), std::sqrt(1 - height), turn);
    const double sides = both ? 2 : 1;
    weight_ = world_.emission_at(from, out) * (sides * std::numbers::pi * triangle.area * all / chosen->power);
    brightest_ = weight_.maxCoeff();
    go(from, out);
    return true;
  }

  /// False: it is turned back.
  bool pass_pane(const Hit& hit, const Material& material) {
    const Vec& flat = world_.triangles()[hit.triangle].normal;
    const PaneParts parts = pane(direction_, flat, material);
    const double chance = parts.chance_to_reflect();
    const bool passes = samples_.uniform() >= chance;
    weight_ *= passes ? Colour(parts.passed / (1 - chance)) : Colour(parts.reflected / chance);
    go(hit, passes ? direction_ : mirror(direction_, flat, flat));
    return passes;
  }

  bool pass(const Hit& hit, const Material& material) {
    const Vec& flat = world_.triangles()[hit.triangle].normal;
    const Vec round = world_.shading_normal(hit);
    if (material.model == Model::mirror) {
      weight_ *= material.specular;
      return turn(hit, mirror(direction_, flat, round), 1);
    }
    const double eta = hit.front ? 1 / material.refractive_index : material.refractive_index;
    const GlassWays ways = glass(direction_, flat, round, eta);
    if (samples_.uniform() < ways.reflectance) return turn(hit, mirror(direction_, flat, round), 1);
    weight_ *= material.transmittance;
    return turn(hit, ways.refracted, eta);
  }

  /// eta: refractive index on the side that the light comes from over that where it goes.
  bool turn(const Hit& hit, const Vec& out, double eta) {
    const Vec bent = out - eta * direction_;  // along the normal that turned it
    const Vec& flat = world_.triangles()[hit.triangle].normal;
    const double above = std::fabs(direction_.dot(bent) * out.dot(flat));
    const double below = std::fabs(direction_.dot(flat) * out.dot(bent));
    if (!(below > 0)) return false;
    weight_ *= above / below;
    go(hit, out);
    return true;
  }

  bool scatter(const Hit& hit, const Material& material) {
    const bool glossy = material.model == Model::glossy;
    const Vec& front = world_.triangles()[hit.triangle].normal;
    const Reflection reflection(hit.front ? front : Vec(-front), mirror(direction_, front, world_.shading_normal(hit)),
                                world_.diffuse_at(hit), glossy ? material.specular : Colour::Zero(), material.exponent);
    if (!glossy) show(hit, reflection);
    const double lobe = samples_.uniform();
    const double height = samples_.uniform();
    const Vec out = reflection.sample(lobe, {height, samples_.uniform()});
    const double cosine = reflection.cosine(out);
    const double density = reflection.density(out);
    if (cosine <= 0 || density <= 0) return false;
    weight_ *= reflection.value(out) * (cosine / density);
    go(hit, out);
    return (weight_ > 0).any();
  }

  void show(const Hit& hit, const Reflection& reflection) {
    const Vec out = (eye_.place() - hit.point).normalized();
    const double cosine = reflection.cosine(out);
    if (cosine <= 0) return;
    const auto seen = eye_.see(hit.point);
    if (!seen) return;
    const Colour through = passed(world_, world_.leave(hit, out), eye_.place(), hit.triangle, kNoTriangle);
    sums_[seen->pixel] += weight_ * through * reflection.value(out) * (cosine * seen->share);
  }

  void go(const Hit& hit, const Vec& direction) {
    origin_ = world_.leave(hit, direction);
    direction_ = direction;
    leaving_ = hit.triangle;
  }

  bool survives() {
    constexpr unsigned kSure = 4;
    if (++turns_ <= kSure) return true;
    const double chance = std::min(0.97, weight_.maxCoeff() / brightest_);
    if (samples_.uniform() >= chance) return false;
    weight_ /= chance;
    return true;
  }

  const World& world_;
  const Eye& eye_;
  Samples& samples_;
  Sums& sums_;
  Vec origin_ = Vec::Zero();
  Vec direction_ = Vec::Zero();
  std::uint32_t leaving_ = kNoTriangle;
  Colour weight_ = Colour::Zero();  // flux of this path, were it the only one
  double brightest_ = 0;            // of its channels at the start
  unsigned turns_ = 0;
};

Picture picture_of(const Sums& sums, const TraceChoice& choice, double paths) {
  Picture picture{choice.width, choice.height, {}};
  for (const Colour& sum : sums) {
    picture.pixels.push_back(
        {static_cast<float>(sum[0] / paths), static_cast<float>(sum[1] / paths), static_cast<float>(sum[2] / paths)});
  }
  return picture;
}

}  // namespace

TracedPicture trace_caustics(const World& world, const Camera& camera, const TraceChoice& choice) {
  const Eye eye(camera, choice);
  if (eye.has_lens()) throw std::invalid_argument("caustics from the light are for cameras without a lens");
  const std::size_t pixels = std::size_t{choice.width} * choice.height;
  const auto paths =
      static_cast<std::uint32_t>(std::ceil(static_cast<double>(pixels) * choice.samples / (2.0 * kStreamsOfHalf)));
  std::vector<Sums> streams(std::size_t{2} * kStreamsOfHalf, Sums(pixels, Colour::Zero()));
  std::atomic<std::uint32_t> next = 0;
  const auto work = [&] {
    for (std::uint32_t stream = next++; stream < streams.size(); stream = next++) {
      // Apart from those of the pixels.
      Samples samples(~choice.seed, stream);
      for (std::uint32_t path = 0; path < paths; ++path) {
        samples.begin(path);
        LightPath(world, eye, samples, streams[stream]).follow();
      }
    }
  };
  std::vector<std::jthread> helpers;
  const unsigned threads = choice.threads > 0 ? choice.threads : std::max(1U, std::thread::hardware_concurrency());
  for (unsigned i = 1; i < threads; ++i) helpers.emplace_back(work);
  work();
  helpers.clear();
  std::array<Sums, 2> halves{Sums(pixels, Colour::Zero()), Sums(pixels, Colour::Zero())};
  for (std::size_t stream = 0; stream < streams.size(); ++stream) {
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) halves[stream % 2][pixel] += streams[stream][pixel];
  }
  const double of_half = static_cast<double>(paths) * kStreamsOfHalf;
  TracedPicture result{{}, picture_of(halves[0], choice, of_half), picture_of(halves[1], choice, of_half)};
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) halves[0][pixel] += halves[1][pixel];
  result.picture = picture_of(halves[0], choice, 2 * of_half);
  return result;
}

}  // namespace torolux::references
