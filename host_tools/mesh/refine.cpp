// SPDX-License-Identifier: MIT
// See refine.hpp.
#include "host_tools/mesh/refine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/lattice.hpp"

namespace torolux {
namespace {

/// Levels that are added to an element at most,
constexpr std::uint32_t kMostAdded = 3;
/// and records of the draft that each part must expect: some dozens when all is solved again.
constexpr double kLeastRecords = 4;
/// A quarter as large an element, across which light changes half as much.
constexpr std::int64_t kChildPart = 8;

struct Wish {
  std::int64_t key;  ///< how much cutting it helps
  Split split;
  std::uint32_t sides;  ///< 1 or 2
  std::uint32_t added;  ///< levels below the draft's element
  double records;       ///< of the draft that came here, about

  bool operator<(const Wish& other) const {  // the greatest comes first, of equal ones the first in the mesh
    return key != other.key ? key < other.key : split > other.split;
  }
};

double sum_of(const protocol::Vec3f& v, const Vec3d& by) {
  return v[0] * by[0] + v[1] * by[1] + v[2] * by[2];
}

/// How wrong interpolated light may be on a side of an element: how far its own light lies off the mean of its
/// corners', and, since shadows are sharper than elements show, some of how much the corners differ; each but for what
/// may be noise of so many records.
double doubt(const protocol::LatticeTriangle& corners, const protocol::Vec3f& own, const Vec3d& reflectance,
             double records) {
  std::array<double, 3> value{};
  for (std::size_t c = 0; c < 3; ++c) value[c] = sum_of(corners.irradiance_over_pi[c], reflectance);
  const double mean = (value[0] + value[1] + value[2]) / 3;
  const auto [least, most] = std::minmax({value[0], value[1], value[2]});
  const double light = sum_of(own, reflectance);
  // Twice: a spread of one is no rarity among thousands of elements.
  const double noise = records > 0 ? 2 * light / std::sqrt(records) : 0;
  return std::max(0.0, std::abs(light - mean) - noise) + 0.25 * std::max(0.0, most - least - noise);
}

/// Of an element, both sides.
struct Doubt {
  Split split;
  std::uint32_t sides;
  double size;
  double records;  ///< of the side that got more
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

double mean_of(const protocol::Flux& flux) {
  return static_cast<double>(flux[0] + flux[1] + flux[2]) / 3;
}

std::vector<Doubt> doubts_of(const Mesh& mesh, const Scene& scene, const DraftLight& draft) {
  const Lattice lattice = make_lattice(mesh, draft.flux, 1, 1);
  std::vector<Doubt> doubts;
  for (const MeshPatch& patch : mesh.patches) {
    if (patch.is_clustered()) continue;
    for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
      const MeshFacet& facet = mesh.facets[f];
      if (facet.is_piece || !(facet.seen > 0)) continue;
      const double area = mesh.facet_area(facet) * facet.seen;
      Doubt worst{{facet.triangle, facet.code}, 0, 0, 0};
      for (std::uint32_t side = 0; side < 2; ++side) {
        if (patch.side[side] == protocol::kNoSide) continue;
        const protocol::Flux& here = draft.flux[patch.first_element[side] + facet.element];
        const double records = draft.of_record > 0 ? mean_of(here) / draft.of_record : HUGE_VAL;
        protocol::Vec3f own{};
        for (std::size_t c = 0; c < 3; ++c)
          own[c] = static_cast<float>(static_cast<double>(here[c]) / area / std::numbers::pi);
        const auto& corners = lattice.triangles[lattice.first[f] + worst.sides];
        const Vec3d& reflectance = scene.materials[patch.material].diffuse;
        worst.size = std::max(worst.size, area * doubt(corners, own, reflectance, records));
        worst.records = std::max(worst.records, records);
        ++worst.sides;
      }
      doubts.push_back(worst);
    }
  }
  return doubts;
}

}  // namespace

std::vector<Split> choose_splits(const Mesh& mesh, const Scene& scene, const DraftLight& draft, std::uint64_t more) {
  const std::vector<Doubt> doubts = doubts_of(mesh, scene, draft);
  double greatest = 0;
  for (const Doubt& here : doubts) greatest = std::max(greatest, here.size);
  std::priority_queue<Wish> wishes;
  for (const Doubt& here : doubts) {
    if (here.size <= 0) continue;
    wishes.push({std::llround(std::ldexp(here.size / greatest, 60)), here.split, here.sides, 0, here.records});
  }
  std::vector<Split> splits;
  for (std::uint64_t added = 0; added < more && !wishes.empty();) {
    const Wish wish = wishes.top();
    wishes.pop();
    if (wish.records < 4 * kLeastRecords || protocol::level_of_code(wish.split.code) == protocol::kMostLevels) continue;
    splits.push_back(wish.split);
    added += 3 * wish.sides;
    if (wish.added + 1 == kMostAdded) continue;
    for (std::uint32_t child = 0; child < 4; ++child) {
      wishes.push({wish.key / kChildPart,
                   {wish.split.triangle, wish.split.code << 2U | child},
                   wish.sides,
                   wish.added + 1,
                   wish.records / 4});
    }
  }
  add_ancestors(splits);
  return splits;
}

}  // namespace torolux
