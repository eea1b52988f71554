// SPDX-License-Identifier: MIT
// An error estimate for each element: what interpolation misses of its light, less the noise by which two drafts
// differ. The split candidate with the greatest is cut first; its children then become candidates.
#include "host_tools/irradiance/refine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/irradiance/concave_edges.hpp"
#include "host_tools/irradiance/surface_vertices.hpp"
#include "host_tools/irradiance/vertex_irradiance.hpp"

namespace torolux {
namespace {

/// Levels that are added to an element at most.
constexpr std::uint32_t kMostAdded = 3;
/// Spreads of the noise that light must differ by: one is no rarity among thousands of elements.
constexpr double kSpreads = 4;
/// Records of both drafts together that each part must expect: some dozens when all is solved again. Where fewer come,
/// two drafts may well agree by chance that nothing does.
constexpr double kLeastRecords = 8;

/// How wrong interpolated light may be on an element, times its area.
struct ErrorEstimate {
  double light = 0;    ///< with noise
  double noise = 0;    ///< its spread
  double records = 0;  ///< of both drafts, that came here

  double beyond_noise() const { return records < 4 * kLeastRecords ? 0 : light - kSpreads * noise; }
};

struct SplitCandidate {
  std::int64_t key;  ///< how much cutting it helps
  Split split;
  std::uint32_t sides;  ///< 1 or 2
  std::uint32_t added;  ///< levels below the draft's element
  ErrorEstimate error;

  bool operator<(const SplitCandidate& other) const {  // the greatest comes first, of equal ones the first in the mesh
    return key != other.key ? key < other.key : split > other.split;
  }
};

double sum_of(const protocol::Vec3f& v, const Vec3d& by) {
  return v[0] * by[0] + v[1] * by[1] + v[2] * by[2];
}

/// Of a facet: how far its own light lies off the mean of its corners', and its corners from each other.
using Deviation = std::array<double, 4>;

/// What interpolation makes of the two solutions on one side of all surfaces, and how much of it is noise: by how much
/// they differ on the elements around.
class SideErrors {
 public:
  SideErrors(const Mesh& mesh, const Scene& scene, const DraftLight& draft,
             const std::array<VertexIrradiance, 2>& irradiances, std::uint32_t side)
      : mesh_(mesh), draft_(draft), side_(side), vertices_(mesh, side), noise_(vertices_.count()) {
    for (std::size_t k = 0; k < 2; ++k) {
      deviations_[k].resize(mesh.facets.size());
      for (const MeshPatch& patch : mesh.patches) {
        for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
          if (!may_cut(patch, f)) continue;
          deviations_[k][f] =
              deviation(patch, f, draft.flux[k], irradiances[k], scene.materials[patch.material].diffuse);
        }
      }
    }
    note_noise();
  }

  /// Neither clusters nor what walls have cut as far as they can.
  bool may_cut(const MeshPatch& patch, std::uint32_t facet) const {
    const MeshFacet& at = mesh_.facets[facet];
    return patch.side[side_] != protocol::kNoSide && !patch.is_clustered() && !at.is_piece && at.seen > 0;
  }

  /// Shadows are sharper than elements show, so some of what corners differ by counts, too.
  ErrorEstimate of(const MeshPatch& patch, std::uint32_t facet) const {
    const Deviation& a = deviations_[0][facet];
    const Deviation& b = deviations_[1][facet];
    const auto mean = [&](std::size_t i) { return std::abs(a[i] + b[i]) / 2; };
    // In a corner of the room noise is greater than beside it, and by luck both solutions may be wrong alike.
    const Noise here = noise_of(facet);
    Noise around;
    for (const std::uint32_t v : vertices_.corners(facet)) around.add(noise_[v]);
    const double own = std::max(here.own, around.own / around.count);
    const double corners = std::max(here.corners, around.corners / around.count);
    const double area = seen_area(facet);
    return {area * (mean(0) + kOfCorners * std::max({mean(1), mean(2), mean(3)})),
            area * (std::sqrt(own) + kOfCorners * std::sqrt(corners)), records_of(patch, facet)};
  }

 private:
  static constexpr double kOfCorners = 0.25;

  /// Squares of the spread of two solutions' mean.
  struct Noise {
    double own = 0, corners = 0, count = 0;

    void add(const Noise& more) {
      own += more.own;
      corners += more.corners;
      count += more.count;
    }
  };

  double seen_area(std::uint32_t facet) const {
    return mesh_.facet_area(mesh_.facets[facet]) * mesh_.facets[facet].seen;
  }

  double records_of(const MeshPatch& patch, std::uint32_t facet) const {
    if (!(draft_.of_record > 0)) return HUGE_VAL;
    double flux = 0;
    for (const auto& of_draft : draft_.flux) {
      const protocol::Flux& here = of_draft[patch.first_element[side_] + mesh_.facets[facet].element];
      flux += static_cast<double>(here[0] + here[1] + here[2]) / 3;
    }
    return flux / draft_.of_record;
  }

  Deviation deviation(const MeshPatch& patch, std::uint32_t facet, const std::vector<protocol::Flux>& flux,
                      const VertexIrradiance& irradiance, const Vec3d& reflectance) const {
    const protocol::Flux& here = flux[patch.first_element[side_] + mesh_.facets[facet].element];
    const double to_radiance = 1 / (seen_area(facet) * std::numbers::pi);
    protocol::Vec3f own{};
    for (std::size_t c = 0; c < 3; ++c) own[c] = static_cast<float>(static_cast<double>(here[c]) * to_radiance);
    const bool behind = side_ == 1 && patch.side[0] != protocol::kNoSide;
    const auto& corners = irradiance.triangles[irradiance.first[facet] + (behind ? 1U : 0U)];
    std::array<double, 3> value{};
    for (std::size_t c = 0; c < 3; ++c) value[c] = sum_of(protocol::irradiance_at(corners, c), reflectance);
    const auto weight = mean_weights(protocol::concave_corners(corners));
    const double mean = value[0] * weight[0] + value[1] * weight[1] + value[2] * weight[2];
    return {sum_of(own, reflectance) - mean, value[1] - value[0], value[2] - value[1], value[0] - value[2]};
  }

  Noise noise_of(std::uint32_t facet) const {
    const auto square = [&](std::size_t i) {
      const double half = (deviations_[0][facet][i] - deviations_[1][facet][i]) / 2;
      return half * half;
    };
    return {square(0), (square(1) + square(2) + square(3)) / 3, 1};
  }

  void note_noise() {
    for (const MeshPatch& patch : mesh_.patches) {
      for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
        if (!may_cut(patch, f)) continue;
        const Noise here = noise_of(f);
        for (const std::uint32_t v : vertices_.corners(f)) noise_[v].add(here);
      }
    }
  }

  const Mesh& mesh_;
  const DraftLight& draft_;
  std::uint32_t side_;
  SurfaceVertices vertices_;
  std::array<std::vector<Deviation>, 2> deviations_;  ///< by facet
  std::vector<Noise> noise_;                          ///< by vertex, of the facets around it
};

/// What balancing has cut must stay so for its parts to be cut.
void add_ancestors(std::vector<Split>& splits) {
  const std::size_t chosen = splits.size();
  for (std::size_t i = 0; i < chosen; ++i) {
    for (std::uint32_t code = splits[i].code >> 2U; code != 0; code >>= 2U)
      splits.push_back({splits[i].triangle, code});
  }
  std::sort(splits.begin(), splits.end());
  splits.erase(std::unique(splits.begin(), splits.end()), splits.end());
}

/// The greater of its sides' for each element that may be cut; keys are not set.
std::vector<SplitCandidate> candidates_of(const Mesh& mesh, const Scene& scene, const DraftLight& draft) {
  const IrradiancePlan plan(mesh);
  const std::array<VertexIrradiance, 2> irradiances{make_vertex_irradiance(plan, draft.flux[0], 1, 1),
                                                    make_vertex_irradiance(plan, draft.flux[1], 1, 1)};
  const std::array<SideErrors, 2> sides{SideErrors(mesh, scene, draft, irradiances, 0),
                                        SideErrors(mesh, scene, draft, irradiances, 1)};
  std::vector<SplitCandidate> candidates;
  for (const MeshPatch& patch : mesh.patches) {
    for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
      SplitCandidate candidate{0, {mesh.facets[f].triangle, mesh.facets[f].code}, 0, 0, {}};
      for (const SideErrors& side : sides) {
        if (!side.may_cut(patch, f)) continue;
        const ErrorEstimate error = side.of(patch, f);
        if (candidate.sides == 0 || error.beyond_noise() > candidate.error.beyond_noise()) candidate.error = error;
        ++candidate.sides;
      }
      if (candidate.sides > 0) candidates.push_back(candidate);
    }
  }
  return candidates;
}

/// Of a quarter as large an element, across which light changes half as much. Its noise is twice as much; but that of
/// the whole solution, which has some four times the records of both drafts, is half of the drafts'.
ErrorEstimate of_child(const SplitCandidate& candidate) {
  return {candidate.error.light / 8, candidate.error.noise / (candidate.added == 0 ? 4 : 2),
          candidate.error.records / 4};
}

}  // namespace

std::vector<Split> choose_splits(const Mesh& mesh, const Scene& scene, const DraftLight& draft, std::uint64_t more) {
  std::vector<SplitCandidate> all = candidates_of(mesh, scene, draft);
  double greatest = 0;
  for (const SplitCandidate& candidate : all) greatest = std::max(greatest, candidate.error.beyond_noise());
  std::priority_queue<SplitCandidate> candidates;
  const auto propose = [&](SplitCandidate candidate) {
    const double beyond = candidate.error.beyond_noise();
    if (beyond <= 0 || protocol::level_of_code(candidate.split.code) == protocol::kMostLevels) return;
    candidate.key = std::llround(std::ldexp(beyond / greatest, 60));
    candidates.push(candidate);
  };
  for (const SplitCandidate& candidate : all) propose(candidate);
  std::vector<Split> splits;
  for (std::uint64_t added = 0; added < more && !candidates.empty();) {
    const SplitCandidate candidate = candidates.top();
    candidates.pop();
    splits.push_back(candidate.split);
    added += 3 * candidate.sides;
    if (candidate.added + 1 == kMostAdded) continue;
    for (std::uint32_t child = 0; child < 4; ++child) {
      propose({0,
               {candidate.split.triangle, candidate.split.code << 2U | child},
               candidate.sides,
               candidate.added + 1,
               of_child(candidate)});
    }
  }
  add_ancestors(splits);
  return splits;
}

}  // namespace torolux
