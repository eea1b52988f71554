// SPDX-License-Identifier: MIT
// Finds connected surfaces by sorting edges and joining their triangles.
#include "host_tools/scene/components.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace torolux {
namespace {

struct Edge {
  std::uint32_t low, high;  // positions
  SurfaceKind kind;
  bool upwards;  // from low to high
  std::uint32_t triangle;

  auto key() const { return std::tie(kind, low, high); }
};

class Sets {
 public:
  explicit Sets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), std::uint32_t{0}); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::vector<Edge> sorted_edges(const Scene& scene) {
  std::vector<Edge> edges;
  edges.reserve(scene.triangles.size() * 3);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const SceneTriangle& triangle = scene.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle.position[i];
      const std::uint32_t b = triangle.position[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), scene.materials[triangle.material].kind, a < b, t});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tuple(a.key(), a.triangle, a.upwards) < std::tuple(b.key(), b.triangle, b.upwards);
  });
  return edges;
}

}  // namespace

std::vector<Component> components(const Scene& scene) {
  const std::vector<Edge> edges = sorted_edges(scene);
  Sets sets(scene.triangles.size());
  std::vector<bool> open(scene.triangles.size(), false);
  std::vector<bool> twice(scene.triangles.size(), false);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    std::size_t upwards = 0;
    while (end < edges.size() && edges[end].key() == edges[i].key()) {
      sets.join(edges[i].triangle, edges[end].triangle);
      upwards += edges[end].upwards ? 1U : 0U;
      ++end;
    }
    const std::size_t count = end - i;
    open[edges[i].triangle] = open[edges[i].triangle] || count % 2 != 0 || 2 * upwards != count;
    // An edge that three or more meet has no one way to be wound.
    twice[edges[i].triangle] = twice[edges[i].triangle] || (count == 2 && upwards != 1);
    i = end;
  }
  std::map<std::uint32_t, std::size_t> number;
  std::vector<Component> found;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const auto [entry, fresh] = number.emplace(sets.root(t), found.size());
    if (fresh) found.push_back({{}, {}, true, 0, true});
    Component& component = found[entry->second];
    component.triangles.push_back(t);
    component.closed = component.closed && !open[t];
    component.one_way = component.one_way && !twice[t];
    for (const std::uint32_t p : scene.triangles[t].position) component.box.include(scene.positions[p]);
  }
  for (Component& component : found) {
    const Vec3d& origin = component.box.low;
    for (const std::uint32_t t : component.triangles) {
      const auto& p = scene.triangles[t].position;
      const Vec3d a = vec::subtract(scene.positions[p[0]], origin);
      const Vec3d b = vec::subtract(scene.positions[p[1]], origin);
      const Vec3d c = vec::subtract(scene.positions[p[2]], origin);
      component.volume += vec::dot(a, vec::cross(b, c)) / 6;
    }
  }
  return found;
}

}  // namespace torolux
