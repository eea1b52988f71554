// SPDX-License-Identifier: MIT
// Sorts positions into cells of a few times the short way, and looks into those around a point.
#include "host_tools/scene/near_vertices.hpp"

#include <algorithm>
#include <cmath>

namespace torolux {

std::array<long, 3> NearVertices::cell_of(const Vec3d& point) const {
  const Vec3d from_low = vec::scale(vec::subtract(point, low_), 0.25 / near_);
  return {std::lround(from_low[0]), std::lround(from_low[1]), std::lround(from_low[2])};
}

void NearVertices::add(std::uint32_t position) {
  if (known_.size() <= position) known_.resize(position + std::size_t{1});
  if (known_[position]) return;
  known_[position] = true;
  cells_[cell_of(scene_.positions[position])].push_back(position);
}

std::uint32_t NearVertices::at(const Vec3d& point) {
  const auto middle = cell_of(point);
  for (long i = 0; i < 27; ++i) {
    const auto cell = cells_.find({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1});
    if (cell == cells_.end()) continue;
    for (const std::uint32_t p : cell->second)
      if (vec::length(vec::subtract(scene_.positions[p], point)) <= near_) return p;
  }
  scene_.positions.push_back(point);
  const auto p = static_cast<std::uint32_t>(scene_.positions.size() - 1);
  add(p);
  return p;
}

void NearVertices::forget_from(std::size_t position) {
  for (std::size_t p = position; p < scene_.positions.size(); ++p)
    std::erase(cells_[cell_of(scene_.positions[p])], static_cast<std::uint32_t>(p));
  scene_.positions.resize(position);
  known_.resize(std::min(known_.size(), position));
}

std::vector<std::uint32_t> NearVertices::all() const {
  std::vector<std::uint32_t> all;
  for (const auto& [cell, members] : cells_) all.insert(all.end(), members.begin(), members.end());
  return all;
}

}  // namespace torolux
