// SPDX-License-Identifier: MIT
// A queue by heat per byte. When a subspace is taken, those that share its polygons or textures take fewer bytes, and
// are offered anew. Also: the bytes of polygons and surfaces.
#include "host_tools/layout/copies.hpp"

#include <algorithm>
#include <queue>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/polygon_groups.hpp"

namespace torolux {
namespace {

using protocol::Stage;

/// Something that stands in a PE's stores once, whichever of its cells need it: a polygon or texture. (Materials stand
/// on every PE anyway.)
struct Item {
  std::uint64_t bytes = 0;
  double lacking = 1;            ///< share of the PEs that would not have it anyway
  std::vector<CellIndex> cells;  ///< that need it
  bool taken = false;
};

/// Polygons, then textures.
class Items {
 public:
  Items(const Mesh& mesh, std::span<const std::vector<std::uint32_t>> polygons_of_cell, Stage stage,
        std::span<const double> lacking)
      : of_cell_(polygons_of_cell.size()) {
    const auto first_texture = static_cast<std::uint32_t>(mesh.triangles.size());
    items_.resize(first_texture + (stage == Stage::ray_tracing ? mesh.textures.size() : 0));
    for (std::uint32_t t = 0; t < first_texture; ++t) {
      items_[t].bytes = shape_bytes(mesh, mesh.triangles[t], stage);
      if (!lacking.empty()) items_[t].lacking = lacking[t];
    }
    for (std::size_t i = first_texture; i < items_.size(); ++i) {
      const auto& texels = mesh.textures[i - first_texture].texels;
      items_[i].bytes = sizeof(protocol::Texture) + texels.size() * sizeof(protocol::Texel);
    }
    for (CellIndex cell = 0; cell < of_cell_.size(); ++cell) {
      std::vector<std::uint32_t>& needed = of_cell_[cell];
      needed = polygons_of_cell[cell];
      for (const std::uint32_t t : polygons_of_cell[cell]) {
        const MeshTriangle& triangle = mesh.triangles[t];
        const bool textured = stage == Stage::ray_tracing && triangle.texture != protocol::kNoTexture;
        if (textured) needed.push_back(first_texture + triangle.texture);
      }
      std::sort(needed.begin(), needed.end());
      needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
      for (const std::uint32_t item : needed) items_[item].cells.push_back(cell);
    }
  }

  const std::vector<std::uint32_t>& of_cell(CellIndex cell) const { return of_cell_[cell]; }
  Item& operator[](std::uint32_t item) { return items_[item]; }
  /// What each cell has of an item's bytes while nobody has taken it.
  double part(std::uint32_t item) const {
    return items_[item].lacking * static_cast<double>(items_[item].bytes) /
           static_cast<double>(items_[item].cells.size());
  }

 private:
  std::vector<Item> items_;
  std::vector<std::vector<std::uint32_t>> of_cell_;
};

/// Above all ratios of heat per byte.
constexpr double kMoreThanAShare = 1e12;

/// A cell that may be taken next. Outdated where the cell's bytes have become fewer since.
struct Offer {
  double heat_per_byte;
  CellIndex cell;
  double bytes;
  bool operator<(const Offer& other) const {
    return heat_per_byte != other.heat_per_byte ? heat_per_byte < other.heat_per_byte : cell > other.cell;
  }
};

}  // namespace

SurfaceSize surface_size(const Mesh& mesh, std::uint32_t part) {
  const MeshTriangle& triangle = mesh.triangles[mesh.facets[mesh.parts[part].facet].triangle];
  const std::uint32_t last = triangle.first_part + protocol::triangles_of_level(triangle.patch_level) - 1;
  const std::uint32_t end =
      part == last ? mesh.parts[triangle.first_part].facet + triangle.facets : mesh.parts[part + 1].facet;
  const std::uint32_t facets = end - mesh.parts[part].facet;
  // Every four children add three leaves.
  return {(facets - 1) / 3 * 4, facets * triangle.side_count()};
}

std::uint64_t polygon_bytes(const MeshTriangle& triangle, Stage stage) {
  std::uint64_t bytes = sizeof(protocol::Polygon);
  if (triangle.normals != protocol::kNoPolygon) bytes += 3 * sizeof(protocol::Vec3f);
  const bool radiosity = stage == Stage::radiosity;
  if (!radiosity && triangle.texture != protocol::kNoTexture) bytes += 3 * sizeof(protocol::TexturePoint);
  if (triangle.sides == 0) return bytes;
  const std::uint32_t parts = protocol::triangles_of_level(triangle.patch_level);
  if (radiosity) return bytes + parts * sizeof(protocol::PatchReference);
  // Every four children add three leaves.
  bytes += (triangle.facets - 1U) / 3 * 4 * sizeof(std::uint32_t);
  return bytes + std::uint64_t{triangle.side_count()} * triangle.facets * sizeof(protocol::CornerIrradiance);
}

std::uint64_t shape_bytes(const Mesh& mesh, const MeshTriangle& triangle, Stage stage) {
  std::uint64_t bytes = polygon_bytes(triangle, stage);
  if (stage == Stage::radiosity || triangle.sides == 0) return bytes;
  for (std::uint32_t path = 0; path < protocol::triangles_of_level(triangle.patch_level); ++path) {
    bytes -= surface_size(mesh, triangle.first_part + path).bytes();
  }
  return bytes;
}

std::vector<double> worth_of_surfaces(const Mesh& mesh, std::span<const double> heat) {
  std::vector<double> worth(mesh.parts.size());
  for (const MeshTriangle& triangle : mesh.triangles) {
    if (triangle.sides == 0) continue;
    for (std::uint32_t path = 0; path < protocol::triangles_of_level(triangle.patch_level); ++path) {
      const std::uint32_t part = triangle.first_part + path;
      worth[part] = heat[part] / static_cast<double>(surface_size(mesh, part).bytes());
    }
  }
  return worth;
}

std::uint64_t cell_bytes(std::size_t polygons) {
  return sizeof(protocol::Subspace) + listed_entries(polygons) * sizeof(protocol::ListedPolygon);
}

std::vector<bool> CopyOrder::first(std::size_t count, std::size_t of_cells) const {
  std::vector<bool> marked(of_cells);
  for (std::size_t i = 0; i < count; ++i) marked[cells[i]] = true;
  return marked;
}

std::size_t CopyOrder::worth_at_least(double least) const {
  const auto end = std::partition_point(worth.begin(), worth.end(), [&](double w) { return w >= least; });
  return static_cast<std::size_t>(end - worth.begin());
}

CopyOrder copy_order(const Mesh& mesh, std::span<const std::vector<std::uint32_t>> polygons_of_cell, Stage stage,
                     std::span<const double> heat, std::span<const double> lacking, double share) {
  Items items(mesh, polygons_of_cell, stage, lacking);
  std::vector<double> bytes(polygons_of_cell.size());
  std::vector<bool> taken(polygons_of_cell.size());
  std::priority_queue<Offer> offers;
  const auto offer = [&](CellIndex cell) {
    const double factor = heat[cell] > share ? kMoreThanAShare : 1;
    offers.push({factor * heat[cell] / bytes[cell], cell, bytes[cell]});
  };
  for (CellIndex cell = 0; cell < bytes.size(); ++cell) {
    if (polygons_of_cell[cell].empty()) continue;
    bytes[cell] = static_cast<double>(cell_bytes(polygons_of_cell[cell].size()));
    for (const std::uint32_t item : items.of_cell(cell)) bytes[cell] += items.part(item);
    offer(cell);
  }
  CopyOrder order;
  std::uint64_t sum = 0;
  while (!offers.empty()) {
    const Offer best = offers.top();
    offers.pop();
    if (taken[best.cell] || best.bytes != bytes[best.cell]) continue;
    taken[best.cell] = true;
    sum += cell_bytes(polygons_of_cell[best.cell].size());
    std::vector<CellIndex> cheaper;
    for (const std::uint32_t number : items.of_cell(best.cell)) {
      Item& item = items[number];
      if (item.taken) continue;
      item.taken = true;
      sum += item.bytes;
      for (const CellIndex cell : item.cells) bytes[cell] -= items.part(number);
      cheaper.insert(cheaper.end(), item.cells.begin(), item.cells.end());
    }
    order.cells.push_back(best.cell);
    order.worth.push_back(order.worth.empty() ? best.heat_per_byte : std::min(best.heat_per_byte, order.worth.back()));
    order.bytes.push_back(sum);
    std::sort(cheaper.begin(), cheaper.end());
    cheaper.erase(std::unique(cheaper.begin(), cheaper.end()), cheaper.end());
    for (const CellIndex cell : cheaper) {
      if (!taken[cell]) offer(cell);
    }
  }
  return order;
}

}  // namespace torolux
