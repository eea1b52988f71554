// SPDX-License-Identifier: MIT
// Points one by one (Lawson 1977), then the border's edges by flips (S. Sloan, A fast algorithm for generating
// constrained Delaunay triangulations, Computers & Structures 47, 1993), then what lies inside.
#include "host_tools/mesh/delaunay.hpp"

#include <algorithm>
#include <deque>

#include "host_tools/mesh/plane_predicates.hpp"

namespace torolux {
namespace {

constexpr std::uint32_t next(std::uint32_t i) {
  return i == 2 ? 0 : i + 1;
}
constexpr std::uint32_t previous(std::uint32_t i) {
  return i == 0 ? 2 : i - 1;
}

}  // namespace

Triangulation::Triangulation() {
  constexpr std::int32_t far = kMostOfPlane * 8;
  points_ = {{-far, -far}, {far, -far}, {0, far}};
  at_ = {0, 0, 0};
  triangles_.push_back({{0, 1, 2}, {kNone, kNone, kNone}});
}

std::optional<Triangulation> Triangulation::make(std::span<const LatticePoint> points, const Border& border) {
  Triangulation result;
  for (const LatticePoint& point : points)
    if (!result.add(point)) return std::nullopt;
  for (const auto& [a, b] : border)
    if (!result.fix(a + kAround, b + kAround)) return std::nullopt;
  std::vector<EdgePlace> all;
  for (std::uint32_t t = 0; t < result.triangles_.size(); ++t)
    for (std::uint32_t i = 0; i < 3; ++i) all.push_back({t, i});
  result.make_delaunay(std::move(all));
  if (!result.fill(border)) return std::nullopt;
  return result;
}

std::vector<std::array<std::uint32_t, 3>> Triangulation::triangles() const {
  std::vector<std::array<std::uint32_t, 3>> inside;
  for (const Triangle& t : triangles_)
    if (t.inside) inside.push_back({t.corner[0] - kAround, t.corner[1] - kAround, t.corner[2] - kAround});
  return inside;
}

std::array<LatticePoint, 3> Triangulation::corners(const Triangle& t) const {
  return {points_[t.corner[0]], points_[t.corner[1]], points_[t.corner[2]]};
}

std::uint32_t Triangulation::index_of(std::uint32_t triangle, std::uint32_t corner) const {
  const auto& corners = triangles_[triangle].corner;
  return static_cast<std::uint32_t>(std::ranges::find(corners, corner) - corners.begin());
}

std::uint32_t Triangulation::index_towards(std::uint32_t triangle, std::uint32_t neighbour) const {
  const auto& beside = triangles_[triangle].beside;
  return static_cast<std::uint32_t>(std::ranges::find(beside, neighbour) - beside.begin());
}

void Triangulation::set(std::uint32_t triangle, const Triangle& value) {
  triangles_[triangle] = value;
  for (const std::uint32_t corner : value.corner) at_[corner] = triangle;
}

void Triangulation::replace_neighbour(std::uint32_t triangle, std::uint32_t old, std::uint32_t now) {
  if (triangle != kNone) triangles_[triangle].beside[index_towards(triangle, old)] = now;
}

bool Triangulation::outside_edge(std::uint32_t triangle, std::uint32_t i, LatticePoint p) const {
  const auto& corner = triangles_[triangle].corner;
  return plane::turn(points_[corner[next(i)]], points_[corner[previous(i)]], p) < 0;
}

std::optional<Triangulation::EdgePlace> Triangulation::find_edge(std::uint32_t a, std::uint32_t b) const {
  std::uint32_t t = at_[a];
  do {
    const std::uint32_t i = index_of(t, a);
    if (triangles_[t].corner[next(i)] == b) return EdgePlace{t, previous(i)};
    t = triangles_[t].beside[next(i)];
  } while (t != at_[a] && t != kNone);
  return std::nullopt;
}

Triangulation::Pair Triangulation::pair_at(std::uint32_t t, std::uint32_t i) const {
  const Triangle& one = triangles_[t];
  const std::uint32_t u = one.beside[i];
  const std::uint32_t j = index_towards(u, t);
  const Triangle& two = triangles_[u];
  return {u, i, j, one, two, one.corner[i], one.corner[next(i)], one.corner[previous(i)], two.corner[j]};
}

void Triangulation::flip(std::uint32_t t, std::uint32_t edge) {
  const auto [u, i, j, one, two, p, a, b, q] = pair_at(t, edge);
  set(t, {{p, a, q},
          {two.beside[next(j)], u, one.beside[previous(i)]},
          {two.fixed[next(j)], false, one.fixed[previous(i)]}});
  set(u, {{p, q, b},
          {two.beside[previous(j)], one.beside[next(i)], t},
          {two.fixed[previous(j)], one.fixed[next(i)], false}});
  replace_neighbour(two.beside[next(j)], u, t);
  replace_neighbour(one.beside[next(i)], t, u);
}

bool Triangulation::flips_well(std::uint32_t t, std::uint32_t i) const {
  const std::uint32_t u = triangles_[t].beside[i];
  const LatticePoint p = points_[triangles_[t].corner[i]];
  const LatticePoint q = points_[triangles_[u].corner[index_towards(u, t)]];
  return plane::turn(p, points_[triangles_[t].corner[next(i)]], q) > 0 &&
         plane::turn(q, points_[triangles_[t].corner[previous(i)]], p) > 0;
}

bool Triangulation::is_delaunay(std::uint32_t t, std::uint32_t i) const {
  const std::uint32_t u = triangles_[t].beside[i];
  if (u == kNone || triangles_[t].fixed[i]) return true;
  const std::uint32_t beyond = triangles_[u].corner[index_towards(u, t)];
  const plane::Wide inside = plane::in_circle(corners(triangles_[t]), points_[beyond]);
  if (inside != 0) return inside < 0;
  // Four on a circle: the diagonal with the first of them, so that the result depends on the points' order alone.
  const auto& corner = triangles_[t].corner;
  return std::min(corner[next(i)], corner[previous(i)]) < std::min(corner[i], beyond);
}

void Triangulation::make_delaunay(std::vector<EdgePlace> doubtful) {
  while (!doubtful.empty()) {
    const auto [t, i] = doubtful.back();
    doubtful.pop_back();
    if (is_delaunay(t, i) || !flips_well(t, i)) continue;
    const std::uint32_t u = triangles_[t].beside[i];
    flip(t, i);
    for (std::uint32_t edge = 0; edge < 3; ++edge) {
      doubtful.push_back({t, edge});
      doubtful.push_back({u, edge});
    }
  }
}

bool Triangulation::add(LatticePoint point) {
  std::uint32_t t = last_;
  for (std::uint32_t i = 0; i < 3;) {
    if (outside_edge(t, i, point)) {
      t = triangles_[t].beside[i];
      i = 0;
    } else {
      ++i;
    }
  }
  const auto number = static_cast<std::uint32_t>(points_.size());
  for (const std::uint32_t corner : triangles_[t].corner)
    if (points_[corner] == point) return false;
  points_.push_back(point);
  at_.push_back(t);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const auto& corner = triangles_[t].corner;
    if (plane::turn(points_[corner[next(i)]], points_[corner[previous(i)]], point) == 0) {
      split_edge(t, i, number);
      return true;
    }
  }
  split_triangle(t, number);
  return true;
}

void Triangulation::split_triangle(std::uint32_t t, std::uint32_t p) {
  const Triangle old = triangles_[t];
  const auto first = static_cast<std::uint32_t>(triangles_.size());
  triangles_.resize(first + 2);
  const std::array<std::uint32_t, 3> part{t, first, first + 1};
  for (std::uint32_t i = 0; i < 3; ++i) {
    set(part[i],
        {{p, old.corner[next(i)], old.corner[previous(i)]}, {old.beside[i], part[next(i)], part[previous(i)]}});
    if (i > 0) replace_neighbour(old.beside[i], t, part[i]);
  }
  settle(p);
}

/// Halves, on both of its sides; m lies on it. It has two: points lie within the triangle around everything.
void Triangulation::split_edge(std::uint32_t t, std::uint32_t edge, std::uint32_t m) {
  const auto [u, i, j, one, two, p, a, b, q] = pair_at(t, edge);
  const auto first = static_cast<std::uint32_t>(triangles_.size());
  triangles_.resize(first + 2);
  const std::uint32_t beyond_t = first;      // m, b, p
  const std::uint32_t beyond_u = first + 1;  // m, q, b
  set(t, {{m, p, a}, {one.beside[previous(i)], u, beyond_t}});
  set(beyond_t, {{m, b, p}, {one.beside[next(i)], t, beyond_u}});
  set(u, {{m, a, q}, {two.beside[next(j)], beyond_u, t}});
  set(beyond_u, {{m, q, b}, {two.beside[previous(j)], beyond_t, u}});
  replace_neighbour(one.beside[next(i)], t, beyond_t);
  replace_neighbour(two.beside[previous(j)], u, beyond_u);
  settle(m);
}

/// The edges opposite a new point, all around it.
void Triangulation::settle(std::uint32_t point) {
  std::vector<EdgePlace> doubtful;
  std::uint32_t t = at_[point];
  do {
    const std::uint32_t i = index_of(t, point);
    doubtful.push_back({t, i});
    t = triangles_[t].beside[next(i)];
  } while (t != at_[point] && t != kNone);
  last_ = at_[point];
  make_delaunay(std::move(doubtful));
}

/// Absent: an edge that is fixed, or a point, lies in the way.
std::optional<std::vector<std::pair<std::uint32_t, std::uint32_t>>> Triangulation::crossed_by(std::uint32_t a,
                                                                                              std::uint32_t b) const {
  const LatticePoint from = points_[a];
  const LatticePoint to = points_[b];
  std::uint32_t t = at_[a];
  std::uint32_t i = index_of(t, a);
  for (const std::uint32_t first = t;;) {  // the triangle at a through which the way to b leads
    const std::int64_t right = plane::turn(from, to, points_[triangles_[t].corner[next(i)]]);
    const std::int64_t left = plane::turn(from, to, points_[triangles_[t].corner[previous(i)]]);
    if (right < 0 && left > 0) break;
    t = triangles_[t].beside[next(i)];
    if (t == kNone || t == first) return std::nullopt;
    i = index_of(t, a);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (;;) {
    if (triangles_[t].fixed[i]) return std::nullopt;
    const std::uint32_t right = triangles_[t].corner[next(i)];
    const std::uint32_t left = triangles_[t].corner[previous(i)];
    edges.emplace_back(right, left);
    const std::uint32_t u = triangles_[t].beside[i];
    const std::uint32_t j = index_towards(u, t);
    const std::uint32_t beyond = triangles_[u].corner[j];
    if (beyond == b) return edges;
    const std::int64_t side = plane::turn(from, to, points_[beyond]);
    if (side == 0) return std::nullopt;
    t = u;  // goes on through the edge from `beyond` to the corner on its other side
    i = index_of(u, side > 0 ? left : right);
  }
}

bool Triangulation::fix(std::uint32_t a, std::uint32_t b) {
  if (!find_edge(a, b)) {
    const auto crossed = crossed_by(a, b);
    if (!crossed) return false;
    std::deque<std::pair<std::uint32_t, std::uint32_t>> edges(crossed->begin(), crossed->end());
    for (std::size_t tries = 0; !edges.empty(); ++tries) {
      if (tries > 1000 + 100 * crossed->size() * crossed->size()) return false;
      const auto [v, w] = edges.front();
      edges.pop_front();
      const auto place = find_edge(v, w);
      if (!place) return false;
      if (!flips_well(place->triangle, place->opposite)) {
        edges.emplace_back(v, w);
        continue;
      }
      flip(place->triangle, place->opposite);
      const std::uint32_t p = triangles_[place->triangle].corner[0];
      const std::uint32_t q = triangles_[place->triangle].corner[2];
      if (p == a || p == b || q == a || q == b) continue;
      const std::int64_t one = plane::turn(points_[a], points_[b], points_[p]);
      const std::int64_t two = plane::turn(points_[a], points_[b], points_[q]);
      if ((one > 0 && two < 0) || (one < 0 && two > 0)) edges.emplace_back(p, q);
    }
  }
  const auto place = find_edge(a, b);
  if (!place) return false;
  triangles_[place->triangle].fixed[place->opposite] = true;
  const std::uint32_t u = triangles_[place->triangle].beside[place->opposite];
  triangles_[u].fixed[index_towards(u, place->triangle)] = true;
  return true;
}

/// False: what lies left of an edge lies right of another, or reaches beyond all of them.
bool Triangulation::fill(const Border& border) {
  std::vector<std::uint32_t> reached;
  for (const auto& [a, b] : border) {
    const auto place = find_edge(a + kAround, b + kAround);
    if (!place) return false;
    reached.push_back(place->triangle);
  }
  while (!reached.empty()) {
    Triangle& t = triangles_[reached.back()];
    reached.pop_back();
    if (t.inside) continue;
    t.inside = true;
    if (std::ranges::any_of(t.corner, [](std::uint32_t corner) { return corner < kAround; })) return false;
    for (std::uint32_t i = 0; i < 3; ++i)
      if (!t.fixed[i]) reached.push_back(t.beside[i]);
  }
  for (const auto& [a, b] : border) {
    const auto behind = find_edge(b + kAround, a + kAround);
    if (!behind) return false;
    if (triangles_[behind->triangle].inside && std::ranges::find(border, std::pair(b, a)) == border.end()) return false;
  }
  return true;
}

}  // namespace torolux
