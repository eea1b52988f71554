// SPDX-License-Identifier: MIT
// A scene's stores, laid out by hand.
#include "tests/unit/firmware/pe/test_stores.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/protocol/triangle_grid.hpp"

namespace torolux::test {
namespace {

using protocol::Vec3f;

/// Is the polygon's bounding box within the cell's box grown by the margin? More than touching, so conservative.
bool stands_in(const TestPolygon& polygon, const Vec3f& cell_size, const std::array<std::uint32_t, 3>& cell) {
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax({polygon.corner[0][a], polygon.corner[1][a], polygon.corner[2][a]});
    const float margin = 1.5F * protocol::kSubspaceMargin;
    if (high < static_cast<float>(cell[a]) * cell_size[a] - margin) return false;
    if (low > static_cast<float>(cell[a] + 1) * cell_size[a] + margin) return false;
  }
  return true;
}

std::array<double, 3> patch_centre(const TestPolygon& polygon, std::uint32_t path) {
  const protocol::GridTriangle grid = protocol::grid_triangle(path, polygon.patch_level);
  std::array<double, 3> centre{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t w = 0; w < 3; ++w) {
      const double weight = grid.corner[0][w] + grid.corner[1][w] + grid.corner[2][w];
      centre[a] += weight / (3 << protocol::kMostLevels) * static_cast<double>(polygon.corner[w][a]);
    }
  }
  return centre;
}

/// Numbers of patches of the whole scene, and where each is kept.
struct PatchPlace {
  std::uint16_t pe;
  std::uint32_t local;
};
std::vector<std::vector<PatchPlace>> place_patches(const TestScene& scene) {
  std::vector<std::vector<PatchPlace>> places;
  std::vector<std::uint32_t> count(scene.pes, 0);
  for (const TestPolygon& polygon : scene.polygons) {
    std::vector<PatchPlace> of_polygon;
    for (std::uint32_t path = 0; path < protocol::triangles_of_level(polygon.patch_level); ++path) {
      const auto cell = scene.cell_of(patch_centre(polygon, path));
      const std::uint16_t pe = scene.pe_of(cell[0], cell[1], cell[2]);
      of_polygon.push_back({pe, count[pe]++});
    }
    places.push_back(std::move(of_polygon));
  }
  return places;
}

class Builder {
 public:
  Builder(const TestScene& scene, protocol::Stage stage, float irradiance_value)
      : scene_(scene), stage_(stage), irradiance_value_(irradiance_value), places_(place_patches(scene)) {}

  PeStores build(std::uint16_t pe) {
    PeStores out;
    fill_layout(out);
    out.materials = scene_.materials;
    if (stage_ == protocol::Stage::ray_tracing) out.emitters = scene_.emitters;
    for (std::uint32_t p = 0; p < scene_.polygons.size(); ++p) add_polygon(out, pe, p);
    add_cells(out, pe);
    if (stage_ == protocol::Stage::radiosity) out.hemicube = hemicube_table(scene_.hemicube_size);
    return out;
  }

 private:
  void fill_layout(PeStores& out) const {
    protocol::StageLayout& l = out.layout;
    l.stage = stage_;
    l.seed = scene_.seed;
    l.cells = scene_.cells;
    for (std::size_t a = 0; a < 3; ++a) l.cell_size[a] = scene_.size[a] / static_cast<float>(scene_.cells[a]);
    l.open_batches = scene_.open_batches;
    l.own_slots = protocol::own_slots(stage_, scene_.open_batches);
    l.credits_kept = scene_.credits_kept;
    l.bounces = scene_.bounces;
    l.hemicube_size = scene_.hemicube_size;
    l.shot_points = l.emission_points = scene_.points;
    l.points_per_quantum = scene_.points_per_quantum;
    l.apart = scene_.apart;
    l.dense_shot = scene_.dense_shot;
    l.mean_radiosity = scene_.mean_radiosity;
    l.gathers_emission = scene_.gathers_emission;
    l.pixel_scale = scene_.pixel_scale;
    l.least_weight = scene_.least_weight;
    l.layers = scene_.layers;
    l.view.width = l.view.height = protocol::kMostPictureEdge;
    l.view.samples = 1;
  }

  /// Every PE holds every polygon here (lists of subspaces name only what stands in them).
  void add_polygon(PeStores& out, std::uint16_t pe, std::uint32_t number) {
    const TestPolygon& from = scene_.polygons[number];
    protocol::Polygon polygon{};
    polygon.corner = from.corner;
    polygon.number = number;
    polygon.normals = protocol::kNoPolygon;
    polygon.material = from.material;
    polygon.sides = from.sides;
    polygon.patch_level = from.patch_level;
    if (stage_ == protocol::Stage::ray_tracing) {
      const std::uint32_t entries = from.sides == 3 ? 2 : from.sides == 0 ? 0 : 1;
      const auto keeper = static_cast<std::uint16_t>(number % scene_.pes);
      const bool kept = scene_.keep_surfaces && entries > 0;
      if (kept) polygon.surface = protocol::kept_leaf(keeper, number / scene_.pes);
      if (!kept || keeper == pe) {
        auto leaf = static_cast<std::uint32_t>(out.irradiance.size());
        const std::uint32_t tree = add_tree(out, from.element_level, entries, leaf);
        const protocol::Vec3f value{irradiance_value_, irradiance_value_, irradiance_value_};
        out.irradiance.resize(leaf, {{value, value, value}});
        if (!kept) polygon.surface = tree;
        out.kept.resize(number / scene_.pes + 1, {0, protocol::kLeaf});
        out.kept.back() = {static_cast<std::uint32_t>(out.polygons.size()), tree};
      }
    } else {
      polygon.surface = static_cast<std::uint32_t>(out.references.size());
      for (const PatchPlace& place : places_[number]) {
        const auto levels = static_cast<std::uint16_t>(from.element_level - from.patch_level);
        out.references.push_back({place.local, place.pe, levels});
        if (place.pe != pe) continue;
        std::uint32_t element = 0;
        out.parts.push_back({place.local, add_tree(out, levels, 1, element)});
      }
    }
    out.polygons.push_back(polygon);
    if (stage_ == protocol::Stage::radiosity) add_patches(out, pe, number);
  }

  /// A tree cut evenly; its leaves are numbered from `leaf` on, `step` apart. Returns its node.
  static std::uint32_t add_tree(PeStores& out, std::uint32_t levels, std::uint32_t step, std::uint32_t& leaf) {
    if (levels == 0) {
      const std::uint32_t here = protocol::kLeaf | leaf;
      leaf += step;
      return here;
    }
    const auto first = static_cast<std::uint32_t>(out.nodes.size());
    out.nodes.resize(first + 4);
    for (std::uint32_t child = 0; child < 4; ++child) {
      const std::uint32_t node = add_tree(out, levels - 1, step, leaf);
      out.nodes[first + child] = node;
    }
    return first;
  }

  void add_patches(PeStores& out, std::uint16_t pe, std::uint32_t number) {
    const TestPolygon& from = scene_.polygons[number];
    const float element_area =
        area_of(from.corner) / static_cast<float>(protocol::triangles_of_level(from.element_level));
    std::uint32_t global = 0;
    for (std::uint32_t p = 0; p < number; ++p) global += static_cast<std::uint32_t>(places_[p].size());
    for (std::uint32_t path = 0; path < places_[number].size(); ++path) {
      if (places_[number][path].pe != pe) continue;
      const std::uint32_t levels = from.element_level - from.patch_level;
      const std::uint32_t elements = protocol::triangles_of_level(levels);
      protocol::Patch patch{global + path, static_cast<std::uint32_t>(out.facets.size()), elements,
                            elements,      {protocol::kNoSide, protocol::kNoSide},        {}};
      for (std::uint32_t e = 0; e < elements; ++e) {
        const std::uint32_t code = protocol::location_code((path << (2U * levels)) | e, from.element_level);
        out.facets.push_back({number, code, e, 1.0F / static_cast<float>(elements), 1.0F, element_area});
      }
      for (std::size_t c = 0; c < 3; ++c) {
        patch.reflectance[c] = static_cast<std::uint32_t>(
            protocol::to_fraction(static_cast<double>(scene_.materials[from.material].diffuse[c])));
      }
      for (std::uint32_t side = 0; side < 2; ++side) {
        if ((from.sides & (1U << side)) == 0) continue;
        patch.side[side] = static_cast<std::uint32_t>(out.sides.size());
        out.sides.emplace_back().first_element = static_cast<std::uint32_t>(out.elements.size());
        out.elements.resize(out.elements.size() + elements);
      }
      out.patches.push_back(patch);
    }
  }

  /// The subspaces that the PE holds, and its map of all.
  void add_cells(PeStores& out, std::uint16_t pe) const {
    std::uint32_t index = 0;
    for (std::uint32_t z = 0; z < scene_.cells[2]; ++z)
      for (std::uint32_t y = 0; y < scene_.cells[1]; ++y)
        for (std::uint32_t x = 0; x < scene_.cells[0]; ++x, ++index) {
          if (index % 32 == 0) out.cell_words.push_back({0, static_cast<std::uint32_t>(out.cell_entries.size())});
          std::vector<protocol::ListedPolygon> list;
          for (std::uint32_t p = 0; p < scene_.polygons.size(); ++p) {
            const auto& corner = scene_.polygons[p].corner;
            if (!stands_in(scene_.polygons[p], out.layout.cell_size, {x, y, z})) continue;
            list.push_back({protocol::box_in_cell(corner, out.layout.cell_size, {x, y, z}), p});
          }
          if (list.empty() && !scene_.stop_everywhere) continue;
          out.cell_words.back().stops |= 1U << (index % 32);
          const std::uint16_t owner = scene_.pe_of(x, y, z);
          if (owner != pe && !scene_.copy_all) {
            out.cell_entries.push_back(owner);
            continue;
          }
          if (scene_.groups) group_list(list, 0);
          out.cell_entries.push_back(protocol::held_as(static_cast<std::uint32_t>(out.subspaces.size())));
          out.subspaces.push_back(
              {static_cast<std::uint32_t>(out.polygon_list.size()), static_cast<std::uint32_t>(list.size())});
          out.polygon_list.insert(out.polygon_list.end(), list.begin(), list.end());
        }
  }

  /// Behind `first`, in the opposite order: groups of three and what is left over.
  static void group_list(std::vector<protocol::ListedPolygon>& list, std::size_t first) {
    const std::vector<protocol::ListedPolygon> entries(list.rbegin(), list.rend() - static_cast<std::ptrdiff_t>(first));
    list.resize(first);
    for (std::size_t i = 0; i < entries.size(); i += 3) {
      const std::size_t end = std::min(entries.size(), i + 3);
      protocol::PackedBox box = entries[i].box;
      for (std::size_t k = i; k < end; ++k) box = protocol::box_around(box, entries[k].box);
      list.push_back({box, protocol::kGroup | static_cast<std::uint32_t>(end - i)});
      for (std::size_t k = i; k < end; ++k) list.push_back(entries[k]);
    }
  }

  const TestScene& scene_;
  protocol::Stage stage_;
  float irradiance_value_;
  std::vector<std::vector<PatchPlace>> places_;
};

}  // namespace

pe::Scene PeStores::scene() {
  pe::Scene s;
  s.layout = layout;
  s.map = {cell_words, cell_entries};
  s.subspaces = subspaces;
  s.polygon_list = polygon_list;
  s.polygons = polygons;
  s.materials = materials;
  s.normals = normals;
  s.nodes = nodes;
  s.patch_references = references;
  s.patch_parts = parts;
  s.patches = patches;
  s.patch_sides = sides;
  s.elements = elements;
  s.facets = facets;
  s.hemicube = hemicube;
  s.irradiance = irradiance;
  s.kept = kept;
  s.textures = textures;
  s.texels = texels;
  s.texture_points = texture_points;
  s.sample_places = sample_places;
  s.filter = filter;
  s.emitters = emitters;
  s.prepare();
  return s;
}

std::vector<PeStores> build_stores(const TestScene& scene, protocol::Stage stage, float irradiance_value) {
  Builder builder(scene, stage, irradiance_value);
  std::vector<PeStores> all;
  for (std::uint32_t pe = 0; pe < scene.pes; ++pe) all.push_back(builder.build(static_cast<std::uint16_t>(pe)));
  return all;
}

std::vector<protocol::HemicubeEntry> hemicube_table(std::uint32_t n) {
  // Form factor from a point to the rectangle (0,0)..(x,y) of a face: the corner formula of a differential area.
  const auto top = [](double x, double y) {
    const double a = std::sqrt(1 + x * x), b = std::sqrt(1 + y * y);
    return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2 * std::numbers::pi);
  };
  const auto side = [](double y, double z) {  // face x = 1, from z = 0 up
    return (std::atan(y) - std::atan(y / std::sqrt(1 + z * z)) / std::sqrt(1 + z * z)) / (2 * std::numbers::pi);
  };
  const auto cell = [n](const auto& f, std::uint32_t i, std::uint32_t j) {
    const double u = 2.0 / n;
    return f(u * (i + 1), u * (j + 1)) - f(u * i, u * (j + 1)) - f(u * (i + 1), u * j) + f(u * i, u * j);
  };
  const std::uint32_t half = n / 2;
  std::vector<protocol::HemicubeEntry> table;
  const auto add = [&](double weight) {
    table.push_back(protocol::hemicube_entry(n, static_cast<std::uint32_t>(table.size())));
    table.back().weight = static_cast<std::uint32_t>(std::lround(weight * 0x1p32));
  };
  std::uint64_t sum = 0;
  for (std::uint32_t j = 0; j < half; ++j)
    for (std::uint32_t i = 0; i < half; ++i) {
      add(cell(top, i, j));
      sum += 4ULL * table.back().weight;
    }
  for (std::uint32_t j = 0; j < half; ++j)
    for (std::uint32_t i = 0; i < half; ++i) {
      add(cell(side, i, j));
      sum += 8ULL * table.back().weight;
    }
  table[0].weight += static_cast<std::uint32_t>(((std::int64_t{1} << 32) - static_cast<std::int64_t>(sum)) / 4);
  return table;
}

}  // namespace torolux::test
