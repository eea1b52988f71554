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

/// Levels that are added to an element at most.
constexpr std::uint32_t kMostAdded = 3;
/// A quarter as large an element, across which light changes half as much.
constexpr std::int64_t kChildPart = 8;

struct Wish {
  std::int64_t key;  ///< how much cutting it helps
  Split split;
  std::uint32_t sides;  ///< 1 or 2
  std::uint32_t added;  ///< levels below the draft's element

  bool operator<(const Wish& other) const {  // the greatest comes first, of equal ones the first in the mesh
    return key != other.key ? key < other.key : split > other.split;
  }
};

double sum_of(const protocol::Vec3f& v, const Vec3d& by) {
  return v[0] * by[0] + v[1] * by[1] + v[2] * by[2];
}

/// How wrong interpolated light may be on a side of an element: how far its own light lies off the mean of its
/// corners', and, since shadows are sharper than elements show, some of how much the corners differ.
double doubt(const protocol::LatticeTriangle& corners, const protocol::Vec3f& own, const Vec3d& reflectance) {
  std::array<double, 3> value{};
  for (std::size_t c = 0; c < 3; ++c) value[c] = sum_of(corners.irradiance_over_pi[c], reflectance);
  const double mean = (value[0] + value[1] + value[2]) / 3;
  const auto [least, most] = std::minmax({value[0], value[1], value[2]});
  return std::abs(sum_of(own, reflectance) - mean) + 0.25 * (most - least);
}

}  // namespace

std::vector<Split> choose_splits(const Mesh& mesh, const Scene& scene, std::span<const protocol::Flux> flux,
                                 std::uint64_t more) {
  const Lattice lattice = make_lattice(mesh, flux, 1, 1);
  struct Doubt {
    Split split;
    std::uint32_t sides;
    double size;
  };
  std::vector<Doubt> doubts;
  double greatest = 0;
  for (const MeshPatch& patch : mesh.patches) {
    if (patch.is_clustered()) continue;
    for (std::uint32_t e = 0; e < patch.elements; ++e) {
      const MeshFacet& facet = mesh.facets[patch.first_facet + e];
      const double area = mesh.facet_area(facet);
      Doubt worst{{facet.triangle, facet.code}, 0, 0};
      for (std::uint32_t side = 0; side < 2; ++side) {
        if (patch.side[side] == protocol::kNoSide) continue;
        const protocol::Flux& here = flux[patch.first_element[side] + e];
        protocol::Vec3f own{};
        for (std::size_t c = 0; c < 3; ++c)
          own[c] = static_cast<float>(static_cast<double>(here[c]) / area / std::numbers::pi);
        const auto& corners = lattice.triangles[lattice.first[patch.first_facet + e] + worst.sides];
        worst.size = std::max(worst.size, area * doubt(corners, own, scene.materials[patch.material].diffuse));
        ++worst.sides;
      }
      greatest = std::max(greatest, worst.size);
      doubts.push_back(worst);
    }
  }
  std::priority_queue<Wish> wishes;
  for (const Doubt& here : doubts) {
    if (here.size > 0) wishes.push({std::llround(std::ldexp(here.size / greatest, 60)), here.split, here.sides, 0});
  }
  std::vector<Split> splits;
  for (std::uint64_t added = 0; added < more && !wishes.empty();) {
    const Wish wish = wishes.top();
    wishes.pop();
    if (protocol::level_of_code(wish.split.code) == protocol::kMostLevels) continue;
    splits.push_back(wish.split);
    added += 3 * wish.sides;
    if (wish.added + 1 == kMostAdded) continue;
    for (std::uint32_t child = 0; child < 4; ++child) {
      wishes.push(
          {wish.key / kChildPart, {wish.split.triangle, wish.split.code << 2U | child}, wish.sides, wish.added + 1});
    }
  }
  std::sort(splits.begin(), splits.end());
  return splits;
}

}  // namespace torolux
