// SPDX-License-Identifier: MIT
// Rounds of weights and of steps of conjugate gradients: each round weighs bends by how much light bends around them,
// then the squares are minimised a little further. All sums are in the order of the mesh.
#include "host_tools/irradiance/light_filter.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// The variance of an element's flux, beside what it would be if records of equal flux came by chance: measured on
/// `cornell_box` over 8 seeds. Records carry unlike flux, but are stratified.
constexpr double kVariance = 1.2;
/// Noise is taken out over so many lengths of elements where light does not bend,
constexpr double kReach = 1.5;
/// and as much of a bend is noise that what this part of noise explains is not believed. Chosen with kReach on
/// `cornell_box` and `interior` (docs/decisions/elements.md).
constexpr double kDoubted = 0.03;
/// No value rises by more than noise explains, in standard deviations: the tips of caustics would.
constexpr double kMostDeviations = 2;
/// Of weights; and steps after each. More change nothing that is seen.
constexpr int kRounds = 4;
constexpr int kSteps = 5;
/// A round: steps, the error that they begin with, and weights. At the end: what is known, and thrice what goes back.
static_assert(kFilterPasses == kRounds * (kSteps + 2) + 4);

using Values = std::vector<Vec3d>;

Vec3d bend_of(const FilterPlan::Bend& bend, const Values& values) {
  Vec3d sum{0, 0, 0};
  for (std::size_t i = 0; i < bend.of.size(); ++i) sum = vec::add(sum, vec::scale(values[bend.vertex[i]], bend.of[i]));
  return sum;
}

class LightFilter {
 public:
  /// All outlive this.
  LightFilter(const FilterPlan& plan, std::span<const protocol::Flux> flux, std::span<const double> flux_of_record,
              Values& values)
      : plan_(plan), flux_(flux), flux_of_record_(flux_of_record), values_(values), weight_(plan.bends().size()) {}

  void run() {
    const Values before = values_;
    for (int round = 0; round < kRounds; ++round) {
      weigh_bends();
      find_scale();
      descend();
    }
    hold_to_noise(before);
    anchor(values_);
  }

 private:
  /// Squares of bends, each the mean of those around: light bends over a neighbourhood, noise at one edge.
  std::vector<double> squares_around() const {
    std::vector<double> sum(values_.size(), 0);
    std::vector<double> count(values_.size(), 0);
    constexpr std::array<std::size_t, 4> corners{0, 1, 2, 3};  // where no vertex hangs: all
    for (const FilterPlan::Bend& bend : plan_.bends()) {
      const double by = vec::sum(bend_of(bend, values_));
      for (const std::size_t i : corners) {
        sum[bend.vertex[i]] += by * by;
        count[bend.vertex[i]] += 1;
      }
    }
    std::vector<double> squares;
    squares.reserve(weight_.size());
    for (const FilterPlan::Bend& bend : plan_.bends()) {
      double all = 0;
      double of = 0;
      for (const std::size_t i : corners) {
        all += sum[bend.vertex[i]];
        of += count[bend.vertex[i]];
      }
      squares.push_back(all / of);
    }
    return squares;
  }

  /// The variance of the channels' sum, of an element's flux, over that flux [quanta].
  double noise_of(const FilterPlan::Triangle& triangle) const {
    return kVariance * 3 * flux_of_record_[triangle.element];
  }

  void weigh_bends() {
    const std::vector<double> squares = squares_around();
    for (std::size_t b = 0; b < weight_.size(); ++b) {
      const FilterPlan::Bend& bend = plan_.bends()[b];
      double area = 0;
      double light = 0;
      double noise = 0;
      for (const std::uint32_t t : bend.triangle) {
        const FilterPlan::Triangle& triangle = plan_.triangles()[t];
        area += triangle.area;
        noise = std::max(noise, noise_of(triangle));
        for (std::size_t c = 0; c < 3; ++c) light += triangle.of_mean[c] * vec::sum(values_[triangle.corner[c]]) / 2;
      }
      // Smoothed over `reach`, noise leaves bends of a spread of sqrt(noise) / reach^3 over a unit of length.
      const double reach = kReach * std::sqrt(area);
      const double doubted = kDoubted * std::sqrt(noise * std::max(0.0, light) * area) / (reach * reach * reach);
      const double bent = doubted > 0 ? std::sqrt(1 + squares[b] / (doubted * doubted)) : 0;
      weight_[b] = bent > 0 ? bend.curvature * reach * reach * reach * reach / bent : 0;
    }
  }

  /// By vertex, what to multiply errors by: one over the diagonal of the squares' matrix.
  void find_scale() {
    scale_.assign(values_.size(), 0);
    for (const FilterPlan::Triangle& triangle : plan_.triangles()) {
      for (std::size_t c = 0; c < 3; ++c)
        scale_[triangle.corner[c]] += triangle.area * triangle.of_mean[c] * triangle.of_mean[c];
    }
    for (std::size_t b = 0; b < weight_.size(); ++b) {
      const FilterPlan::Bend& bend = plan_.bends()[b];
      for (std::size_t i = 0; i < bend.of.size(); ++i) scale_[bend.vertex[i]] += weight_[b] * bend.of[i] * bend.of[i];
    }
  }

  void anchor(Values& values) const {
    for (const FilterPlan::Hanging& at : plan_.hanging()) {
      values[at.vertex] = vec::add(vec::scale(values[at.from], 1 - at.along), vec::scale(values[at.to], at.along));
    }
  }
  /// What pulls at hanging vertices pulls at the ends between which they lie.
  void share_out(Values& pulls) const {
    for (std::size_t i = plan_.hanging().size(); i-- > 0;) {
      const FilterPlan::Hanging& at = plan_.hanging()[i];
      const Vec3d pull = pulls[at.vertex];
      pulls[at.vertex] = {0, 0, 0};
      pulls[at.from] = vec::add(pulls[at.from], vec::scale(pull, 1 - at.along));
      pulls[at.to] = vec::add(pulls[at.to], vec::scale(pull, at.along));
    }
  }

  /// What is known of light at a vertex without the filter.
  struct Known {
    double area = 0;            ///< of the elements around it [user units^2]
    double shown = 0;           ///< likewise, each thrice as far as its light is that of the vertex
    double moved = 0;           ///< the same, with those around vertices that hang on it, as far as they do
    double darkest = HUGE_VAL;  ///< of these, what one received, and may have missed by chance
    double brightest = 0;       ///< of these, what one received [quanta / user unit^2], all channels
    double variance = 0;        ///< the greatest noise_of these
    double noise = 0;           ///< how far off `light` it may be by chance
    double light = 0;           ///< what is known of it
  };
  std::vector<Known> known_of(const Values& before) const {
    std::vector<Known> known(values_.size());
    for (const std::uint32_t v : plan_.free()) known[v].light = std::max(0.0, vec::sum(before[v]));
    for (const FilterPlan::Triangle& triangle : plan_.triangles()) {
      const double own = vec::sum(received(triangle)) / triangle.area;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = triangle.corner[c];
        known[v].area += triangle.area;
        known[v].shown += 3 * triangle.of_mean[c] * triangle.area;
        known[v].variance = std::max(known[v].variance, noise_of(triangle));
        known[v].darkest =
            std::min(known[v].darkest, own + std::sqrt(noise_of(triangle) * known[v].light / triangle.area));
        known[v].brightest = std::max(known[v].brightest, own);
      }
    }
    for (Known& at : known) at.moved = at.shown;
    for (std::size_t i = plan_.hanging().size(); i-- > 0;) {
      const FilterPlan::Hanging& at = plan_.hanging()[i];
      known[at.from].moved += known[at.vertex].moved * (1 - at.along);
      known[at.to].moved += known[at.vertex].moved * at.along;
    }
    for (const std::uint32_t v : plan_.free()) {
      known[v].noise = kMostDeviations * std::sqrt(known[v].variance * known[v].light * known[v].area) / known[v].shown;
    }
    return known;
  }

  /// A value is known as well as the light of the elements around it; but where the darkest of them is darker than
  /// noise explains, the others' light has spread to it over a rim. What is taken of that goes back over the rim.
  void hold_to_noise(const Values& before) {
    const std::vector<Known> known = known_of(before);
    Values taken(values_.size(), {0, 0, 0});
    for (const std::uint32_t v : plan_.free()) {
      const Known& at = known[v];
      const double change = vec::sum(values_[v]) - vec::sum(before[v]);
      const double most = change > 0 ? at.noise : std::max(at.noise, at.light - at.darkest);
      const double part = std::abs(change) > most ? most / std::abs(change) : 1;
      values_[v] = vec::add(before[v], vec::scale(vec::subtract(values_[v], before[v]), part));
      for (double& channel : values_[v]) channel = std::max(0.0, channel);
      const double fall = vec::sum(before[v]) - vec::sum(values_[v]);
      if (fall <= at.noise) continue;
      const double beyond = (1 - at.noise / fall) * at.moved;
      for (std::size_t c = 0; c < 3; ++c) taken[v][c] = beyond * std::max(0.0, before[v][c] - values_[v][c]);
    }
    give_back(taken, known);
  }

  /// To brighter corners of the elements around, in proportion to how much brighter they are; none rises beyond the
  /// brightest element around it, or noise: what would stays where it was. taken: irradiance times Known::moved.
  void give_back(Values& taken, const std::vector<Known>& known) {
    // Of vertices that are not free no light is known: nothing comes to them.
    std::vector<double> shares(values_.size(), 0);
    const auto share = [&](const FilterPlan::Triangle& triangle, std::uint32_t from, std::uint32_t to) {
      return triangle.area * std::max(0.0, known[to].light - known[from].light);
    };
    const auto for_all = [&](const auto& visit) {
      for (const FilterPlan::Triangle& triangle : plan_.triangles()) {
        for (const std::uint32_t from : triangle.corner) {
          for (const std::uint32_t to : triangle.corner) visit(from, to, share(triangle, from, to));
        }
      }
    };
    for_all([&](std::uint32_t from, std::uint32_t, double part) { shares[from] += part; });
    for (const std::uint32_t v : plan_.free()) {
      if (shares[v] > 0) continue;  // else none around is brighter, and free
      values_[v] = vec::add(values_[v], vec::scale(taken[v], 1 / known[v].moved));
      taken[v] = {0, 0, 0};
    }
    Values offered(values_.size(), {0, 0, 0});
    for_all([&](std::uint32_t from, std::uint32_t to, double part) {
      if (part > 0) offered[to] = vec::add(offered[to], vec::scale(taken[from], part / shares[from]));
    });
    std::vector<double> accepted(values_.size(), 0);
    for (const std::uint32_t v : plan_.free()) {
      const Known& at = known[v];
      const double if_all_stays = vec::sum(values_[v]) + vec::sum(taken[v]) / at.moved;
      const double room = std::max(at.light + at.noise, at.brightest) - if_all_stays;
      const double rise = vec::sum(offered[v]) / at.moved;
      accepted[v] = rise > room ? std::max(0.0, room / rise) : 1;
    }
    for_all([&](std::uint32_t from, std::uint32_t to, double part) {
      if (!(part > 0)) return;
      const Vec3d flux = vec::scale(taken[from], part / shares[from]);
      values_[to] = vec::add(values_[to], vec::scale(flux, accepted[to] / known[to].moved));
      values_[from] = vec::add(values_[from], vec::scale(flux, (1 - accepted[to]) / known[from].moved));
    });
  }

  Vec3d flux_by(const FilterPlan::Triangle& triangle, const Values& values) const {
    Vec3d mean{0, 0, 0};
    for (std::size_t c = 0; c < 3; ++c) {
      mean = vec::add(mean, vec::scale(values[triangle.corner[c]], triangle.of_mean[c]));
    }
    return vec::scale(mean, triangle.area);
  }
  /// What pulls at a triangle's mean pulls at its corners.
  static void add_by_mean(const FilterPlan::Triangle& triangle, const Vec3d& pull, Values& pulls) {
    for (std::size_t c = 0; c < 3; ++c) {
      Vec3d& at = pulls[triangle.corner[c]];
      at = vec::add(at, vec::scale(pull, triangle.of_mean[c]));
    }
  }
  Vec3d received(const FilterPlan::Triangle& triangle) const {
    const protocol::Flux& flux = flux_[triangle.element];
    return {static_cast<double>(flux[0]), static_cast<double>(flux[1]), static_cast<double>(flux[2])};
  }

  /// Half the gradient of the squares without what was received: the matrix times the values.
  Values pulls_of(const Values& values) const {
    Values pulls(values.size(), {0, 0, 0});
    for (const FilterPlan::Triangle& triangle : plan_.triangles()) {
      add_by_mean(triangle, flux_by(triangle, values), pulls);
    }
    for (std::size_t b = 0; b < weight_.size(); ++b) {
      const FilterPlan::Bend& bend = plan_.bends()[b];
      const Vec3d by = vec::scale(bend_of(bend, values), weight_[b]);
      for (std::size_t i = 0; i < bend.of.size(); ++i)
        pulls[bend.vertex[i]] = vec::add(pulls[bend.vertex[i]], vec::scale(by, bend.of[i]));
    }
    share_out(pulls);
    return pulls;
  }
  /// What is missing: of the right side less the matrix times the values, at free vertices.
  Values errors() const {
    Values errors(values_.size(), {0, 0, 0});
    for (const FilterPlan::Triangle& triangle : plan_.triangles()) {
      add_by_mean(triangle, received(triangle), errors);
    }
    share_out(errors);
    const Values pulls = pulls_of(values_);
    for (std::size_t v = 0; v < errors.size(); ++v) errors[v] = vec::subtract(errors[v], pulls[v]);
    return errors;
  }

  /// Over free vertices, scaled.
  double product(const Values& a, const Values& b) const {
    double sum = 0;
    for (const std::uint32_t v : plan_.free()) sum += vec::dot(a[v], b[v]);
    return sum;
  }
  Values scaled(const Values& errors) const {
    Values scaled(errors.size(), {0, 0, 0});
    for (const std::uint32_t v : plan_.free()) scaled[v] = vec::scale(errors[v], 1 / scale_[v]);
    return scaled;
  }

  /// Conjugate gradients (Hestenes & Stiefel 1952).
  void descend() {
    Values missing = errors();
    Values way = scaled(missing);
    double square = product(missing, way);
    for (int step = 0; step < kSteps && square > 0; ++step) {
      anchor(way);
      const Values pulls = pulls_of(way);
      const double along = square / product(way, pulls);
      for (const std::uint32_t v : plan_.free()) {
        values_[v] = vec::add(values_[v], vec::scale(way[v], along));
        missing[v] = vec::subtract(missing[v], vec::scale(pulls[v], along));
      }
      const Values next = scaled(missing);
      const double left = product(missing, next);
      for (const std::uint32_t v : plan_.free()) way[v] = vec::add(next[v], vec::scale(way[v], left / square));
      square = left;
    }
    anchor(values_);
  }

  const FilterPlan& plan_;
  std::span<const protocol::Flux> flux_;
  std::span<const double> flux_of_record_;
  Values& values_;
  std::vector<double> weight_;  ///< by bend [user units^4, and those of its curvature]
  std::vector<double> scale_;   ///< by vertex
};

}  // namespace

void filter_light(const FilterPlan& plan, std::span<const protocol::Flux> flux, std::span<const double> flux_of_record,
                  std::vector<Vec3d>& values) {
  LightFilter(plan, flux, flux_of_record, values).run();
}

}  // namespace torolux
