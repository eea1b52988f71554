// SPDX-License-Identifier: MIT
// Grows each cluster over smooth edges, around the first triangle that has none, as far as length and normals allow;
// scraps join a neighbour. Once for elements, then with these for patches.
#include "host_tools/mesh/clusters.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

#include "firmware/protocol/machine.hpp"
#include "firmware/protocol/stores.hpp"
#include "host_tools/mesh/edges.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// A triangle, or a cluster of them, that may become part of a larger one.
struct Member {
  Vec3d centre{0, 0, 0};  ///< [user units]
  Vec3d normal{0, 0, 0};  ///< times area
  double area = 0;
  std::vector<std::uint32_t> neighbours;
  std::size_t triangles = 0;
  double length = HUGE_VAL;  ///< of a cluster that has it, at most
};

/// Normals of members differ from the first one's by no more than this.
constexpr double kElementCosine = 0.8660254037844387;  ///< 30 degrees
constexpr double kPatchCosine = 0.6427876096865394;    ///< 50 degrees
/// Where another surface is near, elements are this much shorter, at most.
constexpr double kShortest = 0.125;
/// A cluster with less than this of a full one's area joins a neighbour.
constexpr double kScrap = 0.25;
/// A patch of fewer stays as it is: a small quadrilateral is no finely tessellated surface.
constexpr std::size_t kFewTriangles = 8;
/// Nor takes one more than this of its owner's memory, which holds all of it: a million triangles may lie within one's
/// length. An eighth of what PEs have where nothing else is said; not of what they have, as no picture goes by that.
constexpr std::size_t kMostTriangles =
    protocol::kDefaultLocalMemory / 8 / (sizeof(protocol::Facet) + sizeof(protocol::PatchPart) + sizeof(std::uint32_t));

double cosine(const Vec3d& a, const Vec3d& b) {
  const double lengths = vec::length(a) * vec::length(b);
  return lengths > 0 ? vec::dot(a, b) / lengths : 0;
}

/// By member: the number of its cluster. Grows each around the first member that has none, as far as half the length.
std::vector<std::uint32_t> grow(const std::vector<Member>& members, double length, double least_cosine) {
  constexpr std::uint32_t none = kNoNeighbour;
  std::vector<std::uint32_t> cluster(members.size(), none);
  std::uint32_t next = 0;
  for (std::uint32_t seed = 0; seed < members.size(); ++seed) {
    if (cluster[seed] != none) continue;
    cluster[seed] = next;
    std::deque<std::uint32_t> reached{seed};
    std::size_t triangles = members[seed].triangles;
    while (!reached.empty()) {
      const std::uint32_t member = reached.front();
      reached.pop_front();
      for (const std::uint32_t other : members[member].neighbours) {
        if (cluster[other] != none) continue;
        const double far = vec::length(vec::subtract(members[other].centre, members[seed].centre));
        const double most = std::min({length, members[seed].length, members[other].length});
        if (far > 0.5 * most || cosine(members[other].normal, members[seed].normal) < least_cosine) continue;
        if (triangles + members[other].triangles > kMostTriangles) continue;
        triangles += members[other].triangles;
        cluster[other] = next;
        reached.push_back(other);
      }
    }
    ++next;
  }
  return cluster;
}

std::vector<Member> merged(const std::vector<Member>& members, const std::vector<std::uint32_t>& cluster) {
  std::vector<Member> result;
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (cluster[m] >= result.size()) result.resize(cluster[m] + 1);
    Member& into = result[cluster[m]];
    into.centre = vec::add(into.centre, vec::scale(members[m].centre, members[m].area));
    into.normal = vec::add(into.normal, members[m].normal);
    into.area += members[m].area;
    into.triangles += members[m].triangles;
    into.length = std::min(into.length, members[m].length);
    for (const std::uint32_t other : members[m].neighbours) {
      if (cluster[other] != cluster[m]) into.neighbours.push_back(cluster[other]);
    }
  }
  for (Member& member : result) {
    member.centre = vec::scale(member.centre, 1 / member.area);
    std::sort(member.neighbours.begin(), member.neighbours.end());
    member.neighbours.erase(std::unique(member.neighbours.begin(), member.neighbours.end()), member.neighbours.end());
  }
  return result;
}

/// What was left over between full clusters joins the neighbour that faces most alike.
void join_scraps(const std::vector<Member>& members, double length, double least_cosine,
                 std::vector<std::uint32_t>& cluster) {
  const std::vector<Member> clusters = merged(members, cluster);
  const auto full = [&](std::uint32_t a, std::uint32_t b) {
    const double least = std::min({length, clusters[a].length, clusters[b].length});
    return std::numbers::pi / 4 * least * least;
  };
  DisjointSets sets(clusters.size());
  std::vector<double> area;
  area.reserve(clusters.size());
  std::vector<std::size_t> triangles;
  triangles.reserve(clusters.size());
  for (const Member& member : clusters) {
    area.push_back(member.area);
    triangles.push_back(member.triangles);
  }
  for (std::uint32_t c = 0; c < clusters.size(); ++c) {
    if (area[sets.root(c)] > kScrap * full(c, c)) continue;
    std::uint32_t best = kNoNeighbour;
    double best_cosine = least_cosine;
    for (const std::uint32_t other : clusters[c].neighbours) {
      const double alike = cosine(clusters[c].normal, clusters[other].normal);
      if (sets.root(other) == sets.root(c) || area[sets.root(other)] > full(c, other) || !(alike > best_cosine))
        continue;
      if (triangles[sets.root(c)] + triangles[sets.root(other)] > kMostTriangles) continue;
      best = other;
      best_cosine = alike;
    }
    if (best == kNoNeighbour) continue;
    const double both = area[sets.root(c)] + area[sets.root(best)];
    const std::size_t count = triangles[sets.root(c)] + triangles[sets.root(best)];
    sets.merge(c, best);
    area[sets.root(c)] = both;
    triangles[sets.root(c)] = count;
  }
  std::vector<std::uint32_t> number(clusters.size(), kNoNeighbour);
  std::uint32_t next = 0;
  for (std::uint32_t& c : cluster) {
    std::uint32_t& named = number[sets.root(c)];
    if (named == kNoNeighbour) named = next++;
    c = named;
  }
}

std::vector<std::uint32_t> clusters_of(const std::vector<Member>& members, double length, double least_cosine) {
  std::vector<std::uint32_t> cluster = grow(members, length, least_cosine);
  join_scraps(members, length, least_cosine, cluster);
  return cluster;
}

/// The small triangles as members; number: of a triangle's member, or kNoNeighbour.
std::vector<Member> members_of(const Mesh& mesh, const Scene& scene, const std::vector<bool>& small,
                               std::vector<std::uint32_t>& triangle_of, std::vector<std::uint32_t>& number) {
  number.assign(mesh.triangles.size(), kNoNeighbour);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!small[t]) continue;
    number[t] = static_cast<std::uint32_t>(triangle_of.size());
    triangle_of.push_back(t);
  }
  std::vector<Member> members;
  for (const std::uint32_t t : triangle_of) {
    const auto& position = mesh.triangles[t].position;
    const Vec3d& a = scene.positions[position[0]];
    const Vec3d& b = scene.positions[position[1]];
    const Vec3d& c = scene.positions[position[2]];
    Member& member = members.emplace_back();
    member.centre = vec::scale(vec::add(vec::add(a, b), c), 1.0 / 3);
    member.normal = vec::scale(vec::cross(vec::subtract(b, a), vec::subtract(c, a)), 0.5);
    member.area = mesh.triangles[t].area;
    member.triangles = 1;
    for (const std::uint32_t other : mesh.smooth.neighbour[t]) {
      if (other != kNoNeighbour && number[other] != kNoNeighbour) member.neighbours.push_back(number[other]);
    }
  }
  return members;
}

/// Gives each triangle the length of a cluster that has it: where another surface is near, less than `length`. Asked
/// once for each part of the shortest length.
void shorten_near_others(const Mesh& mesh, const std::vector<std::uint32_t>& triangle_of, double length,
                         std::vector<Member>& triangles) {
  const std::vector<std::uint32_t> part = clusters_of(triangles, kShortest * length, kElementCosine);
  const std::vector<Member> parts = merged(triangles, part);
  std::vector<double> lengths(parts.size(), 0);
  for (std::size_t m = 0; m < triangles.size(); ++m) {
    double& most = lengths[part[m]];
    if (most == 0) {
      const Member& all = parts[part[m]];
      const double reach = length * mesh.space.scale;
      most = mesh.clearance.at(triangle_of[m], mesh.space.to_normalised(all.centre), vec::unit(all.normal), reach);
      most = std::max(most / mesh.space.scale, kShortest * length);
    }
    triangles[m].length = most;
  }
}

}  // namespace

std::vector<PatchCluster> find_clusters(const Mesh& mesh, const Scene& scene, const std::vector<bool>& small,
                                        double patch_length, double element_length) {
  std::vector<std::uint32_t> triangle_of;
  std::vector<std::uint32_t> number;
  std::vector<Member> triangles = members_of(mesh, scene, small, triangle_of, number);
  shorten_near_others(mesh, triangle_of, element_length, triangles);
  const std::vector<std::uint32_t> element = clusters_of(triangles, element_length, kElementCosine);
  std::vector<Member> whole = merged(triangles, element);
  for (Member& member : whole) member.length = patch_length;
  const std::vector<std::uint32_t> patch = clusters_of(whole, patch_length, kPatchCosine);

  std::vector<ElementCluster> elements(patch.size());
  for (std::size_t m = 0; m < triangles.size(); ++m) elements[element[m]].push_back(triangle_of[m]);
  std::vector<PatchCluster> patches;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (patch[e] >= patches.size()) patches.resize(patch[e] + 1);
    patches[patch[e]].push_back(std::move(elements[e]));
  }
  std::erase_if(patches, [](const PatchCluster& cluster) {
    std::size_t count = 0;
    for (const ElementCluster& part : cluster) count += part.size();
    return count < kFewTriangles;
  });
  return patches;
}

std::uint32_t count_smooth_surfaces(const Mesh& mesh) {
  const SmoothSurfaces smooth =
      find_smooth_surfaces(mesh, std::vector<bool>(mesh.triangles.size(), true), Pierced::goes_on);
  DisjointSets sets(mesh.triangles.size());
  std::uint32_t surfaces = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.triangles[t].sides == 0) continue;
    ++surfaces;
    for (const std::uint32_t other : smooth.neighbour[t]) {
      if (other == kNoNeighbour || sets.root(other) == sets.root(t)) continue;
      sets.merge(t, other);
      --surfaces;
    }
  }
  return surfaces;
}

}  // namespace torolux
