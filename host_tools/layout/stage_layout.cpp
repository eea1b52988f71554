// SPDX-License-Identifier: MIT
// Counts the entries of each store, then gives out addresses from the end of the firmware's image on. A refusal names
// the stores that take most, and the options that lessen them.
#include "host_tools/layout/stage_layout.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <tuple>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/copies.hpp"
#include "host_tools/layout/polygon_groups.hpp"

namespace torolux {
namespace {

using protocol::Stage;
using protocol::StageLayout;
using protocol::Store;

struct Counts {
  std::uint64_t cell_words = 0, cell_entries = 0, subspaces = 0, polygon_list = 0, polygons = 0, materials = 0,
                normals = 0;
  std::uint64_t nodes = 0, patch_references = 0, patch_parts = 0, patches = 0, patch_sides = 0, elements = 0,
                facets = 0, hemicube = 0, irradiance = 0, kept = 0;
  std::uint64_t textures = 0, texels = 0, texture_points = 0;
  std::uint64_t uncut_irradiance = 0, uncut_facets = 0;  ///< of triangles that are one facet, whatever --elements is

  Lessened irradiance_by() const { return 2 * uncut_irradiance > irradiance ? Lessened::pes : Lessened::elements; }
  Lessened facets_by() const { return 2 * uncut_facets > facets ? Lessened::pes : Lessened::elements; }
};

/// Takes away what of the polygons' surfaces others keep.
void leave_to_keepers(const Mesh& mesh, const Placement& placement, protocol::PeNumber pe, Counts& counts) {
  const SurfaceSize& all = placement.surfaces_with_keepers[pe];
  counts.nodes -= all.nodes;
  counts.irradiance -= all.irradiance;
  for (const std::uint32_t part : placement.kept_by_pe[pe]) {
    const SurfaceSize size = surface_size(mesh, part);
    counts.nodes += size.nodes;
    counts.irradiance += size.irradiance;
    if (mesh.patches[mesh.parts[part].patch].is_clustered()) counts.uncut_irradiance += size.irradiance;
  }
  counts.kept = placement.kept_by_pe[pe].size();
}

Counts count(const Mesh& mesh, const Placement& placement, protocol::PeNumber pe, Stage stage, std::uint32_t hemicube) {
  Counts counts;
  counts.cell_words = protocol::cell_words(placement.grid.count());
  counts.cell_entries = placement.stops;
  counts.subspaces = placement.cells_of_pe[pe].size();
  for (const CellIndex cell : placement.cells_of_pe[pe]) {
    counts.polygon_list += listed_entries(placement.polygons_of_cell[cell].size());
  }
  counts.polygons = placement.polygons_of_pe[pe].size();
  for (const std::uint32_t t : placement.polygons_of_pe[pe]) {
    const MeshTriangle& triangle = mesh.triangles[t];
    if (triangle.normals != protocol::kNoPolygon) counts.normals += 3;
    if (triangle.texture != protocol::kNoTexture) counts.texture_points += 3;
    if (triangle.sides == 0) continue;
    if (stage == Stage::radiosity) {
      counts.patch_references += protocol::triangles_of_level(triangle.patch_level);
    } else {
      // Every four children add three leaves.
      counts.nodes += (triangle.facets - 1U) / 3 * 4;
      counts.irradiance += std::uint64_t{triangle.side_count()} * triangle.facets;
      if (triangle.facets == 1 && placement.keeper_of_part.empty()) counts.uncut_irradiance += triangle.side_count();
    }
  }
  if (stage == Stage::ray_tracing && !placement.keeper_of_part.empty()) leave_to_keepers(mesh, placement, pe, counts);
  counts.materials = mesh.materials;
  if (stage == Stage::ray_tracing) {
    for (const std::uint32_t texture : textures_of_pe(mesh, placement, pe)) {
      ++counts.textures;
      counts.texels += mesh.textures[texture].texels.size();
    }
    return counts;
  }
  counts.texture_points = 0;
  for (const std::uint32_t number : placement.patches_of_pe[pe]) {
    const MeshPatch& patch = mesh.patches[number];
    counts.facets += patch.facets;
    if (patch.is_clustered()) counts.uncut_facets += patch.facets;
    for (const std::uint32_t side : patch.side) {
      if (side == protocol::kNoSide) continue;
      ++counts.patch_sides;
      counts.elements += patch.elements;
    }
  }
  counts.patches = placement.patches_of_pe[pe].size();
  counts.patch_parts = placement.parts_of_pe[pe].size();
  for (const std::uint32_t part : placement.parts_of_pe[pe]) counts.nodes += surface_size(mesh, part).nodes;
  counts.hemicube = protocol::hemicube_weights(hemicube);
  return counts;
}

/// Gives out addresses; stores begin at multiples of 8.
class Allocator {
 public:
  Allocator(std::uint64_t begin, PeLayout& pe_layout) : next_(begin), pe_layout_(pe_layout) {}

  Store place(const char* name, Lessened by, std::uint64_t count, std::size_t bytes_each) {
    next_ = (next_ + 7) / 8 * 8;
    const std::uint64_t address = next_;
    const std::uint64_t bytes = count * bytes_each;
    next_ += bytes;
    if (bytes > 0) pe_layout_.bytes.push_back({name, by, bytes});
    return {static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(count)};
  }
  std::uint64_t next() const { return next_; }

 private:
  std::uint64_t next_;
  PeLayout& pe_layout_;
};

/// One for each PE, as far as there are so many.
std::uint32_t open_batches(unsigned pes) {
  return std::min(std::bit_ceil(pes), protocol::kMostOpenBatches);
}

/// Of what a PE needs: one by one are told the stores that take more than one part in so many.
constexpr std::uint64_t kSmallPart = 100;

const char* lessened_words(Lessened by) {
  switch (by) {
    case Lessened::nothing:
      break;
    case Lessened::pes:
      return "less by more --pes";
    case Lessened::subspaces:
      return "less by coarser --subspaces";
    case Lessened::elements:
      return "less by greater --elements";
    case Lessened::patches:
      return "less by greater --patches";
    case Lessened::texels:
      return "less by fewer --texels";
    case Lessened::hemicube:
      return "less by a smaller --hemicube";
    case Lessened::samples:
      return "less by --camera-rays host";
  }
  return "fixed";
}

const char* name_of(Stage stage) {
  return stage == Stage::radiosity ? "radiosity" : "ray tracing";
}

}  // namespace

std::vector<std::uint32_t> textures_of_pe(const Mesh& mesh, const Placement& placement, protocol::PeNumber pe) {
  std::vector<std::uint32_t> textures;
  for (const std::uint32_t t : placement.polygons_of_pe[pe]) {
    if (mesh.triangles[t].texture != protocol::kNoTexture) textures.push_back(mesh.triangles[t].texture);
  }
  std::sort(textures.begin(), textures.end());
  textures.erase(std::unique(textures.begin(), textures.end()), textures.end());
  return textures;
}

PeLayout lay_out(const Mesh& mesh, const Placement& placement, protocol::PeNumber pe, Stage stage,
                 const StageParameters& parameters, const MemoryMap& map) {
  const Counts counts = count(mesh, placement, pe, stage, parameters.hemicube);
  PeLayout result;
  StageLayout& layout = result.layout;
  layout.stage = stage;
  layout.seed = parameters.seed;
  layout.cells = placement.grid.cells;
  layout.cell_size = placement.grid.cell_size;
  layout.bounces = parameters.bounces;
  Allocator allocator(map.stores_begin, result);
  layout.cell_words = allocator.place("cell map", Lessened::subspaces, counts.cell_words, sizeof(protocol::CellWord));
  layout.cell_entries =
      allocator.place("cell entries", Lessened::subspaces, counts.cell_entries, sizeof(protocol::CellEntry));
  layout.subspaces = allocator.place("subspaces", Lessened::subspaces, counts.subspaces, sizeof(protocol::Subspace));
  layout.polygon_list =
      allocator.place("polygon list", Lessened::subspaces, counts.polygon_list, sizeof(protocol::ListedPolygon));
  layout.polygons = allocator.place("polygons", Lessened::pes, counts.polygons, sizeof(protocol::Polygon));
  layout.materials = allocator.place("materials", Lessened::nothing, counts.materials, sizeof(protocol::Material));
  layout.normals = allocator.place("normals", Lessened::pes, counts.normals, sizeof(protocol::Vec3f));
  layout.nodes = allocator.place("nodes", Lessened::elements, counts.nodes, sizeof(std::uint32_t));
  layout.patch_references =
      allocator.place("patch references", Lessened::patches, counts.patch_references, sizeof(protocol::PatchReference));
  layout.patch_parts =
      allocator.place("parts of patches", Lessened::patches, counts.patch_parts, sizeof(protocol::PatchPart));
  layout.patches = allocator.place("patches", Lessened::patches, counts.patches, sizeof(protocol::Patch));
  layout.patch_sides =
      allocator.place("patch sides", Lessened::patches, counts.patch_sides, sizeof(protocol::PatchSide));
  layout.elements = allocator.place("elements", Lessened::elements, counts.elements, sizeof(protocol::Element));
  layout.facets = allocator.place("facets", counts.facets_by(), counts.facets, sizeof(protocol::Facet));
  layout.hemicube = allocator.place("hemi-cube", Lessened::hemicube, counts.hemicube, sizeof(protocol::HemicubeEntry));
  layout.irradiance =
      allocator.place("irradiance", counts.irradiance_by(), counts.irradiance, sizeof(protocol::CornerIrradiance));
  layout.kept = allocator.place("kept surfaces", Lessened::patches, counts.kept, sizeof(protocol::KeptSurface));
  layout.textures = allocator.place("textures", Lessened::texels, counts.textures, sizeof(protocol::Texture));
  layout.texels = allocator.place("texels", Lessened::texels, counts.texels, sizeof(protocol::Texel));
  layout.texture_points =
      allocator.place("texture points", Lessened::pes, counts.texture_points, sizeof(protocol::TexturePoint));
  const std::uint32_t emitters = stage == Stage::ray_tracing ? parameters.emitters : 0;
  const std::uint32_t samples = stage == Stage::ray_tracing ? parameters.pixel_samples : 0;
  const std::uint32_t filter = stage == Stage::ray_tracing ? parameters.filter_entries : 0;
  layout.sample_places = allocator.place("sample places", Lessened::samples, samples, sizeof(protocol::SamplePlace));
  layout.filter = allocator.place("filter", Lessened::samples, filter, sizeof(float));
  layout.emitters = allocator.place("emitters", Lessened::patches, emitters, sizeof(protocol::Emitter));
  const std::uint32_t openings = stage == Stage::radiosity ? parameters.sky_openings : 0;
  layout.sky = allocator.place("sky", Lessened::nothing, parameters.sky_entries, sizeof(protocol::SkyEntry));
  layout.sky_openings = allocator.place("openings", Lessened::nothing, openings, sizeof(protocol::SkyOpening));
  layout.sky_frame = parameters.sky_frame;
  const std::uint32_t chances = stage == Stage::radiosity ? parameters.lamp_chances : 0;
  layout.lamps = allocator.place("lamps", Lessened::nothing, parameters.lamps, sizeof(protocol::Lamp));
  layout.lamp_values = allocator.place("lamp values", Lessened::nothing, parameters.lamp_values, sizeof(float));
  layout.lamp_chances = allocator.place("lamp chances", Lessened::nothing, chances, sizeof(std::uint32_t));
  result.load_end = allocator.next();
  layout.open_batches = open_batches(placement.torus.pes());
  layout.own_slots = protocol::own_slots(stage, layout.open_batches);
  layout.record_slots = allocator.place("record slots", Lessened::nothing,
                                        std::uint64_t{layout.own_slots} + map.niu_slots, protocol::slot_bytes(stage));
  result.end = allocator.next();
  layout.credits_kept = map.credits_per_pe;
  layout.gather_cycles = map.gather_cycles;
  layout.gather_records = map.gather_records;
  if (stage == Stage::radiosity) {
    layout.hemicube_size = parameters.hemicube;
    layout.shot_points = parameters.shot_points;
    layout.emission_points = parameters.emission_points;
    layout.points_per_quantum = parameters.points_per_quantum;
    layout.apart = parameters.apart;
    layout.dense_shot = parameters.dense_shot;
    layout.mean_radiosity = parameters.mean_radiosity;
    layout.gathers_emission = parameters.gathers_emission;
  } else {
    layout.pixel_scale = parameters.pixel_scale;
    layout.least_weight = parameters.least_weight;
    layout.layers = parameters.layers;
  }
  return result;
}

double MemoryNeed::mean() const {
  const double sum = std::accumulate(pe_bytes.begin(), pe_bytes.end(), 0.0);
  return sum / static_cast<double>(pe_bytes.size());
}

void MemoryNeed::add(const Mesh& mesh, const Placement& placement, Stage stage, const StageParameters& parameters,
                     const MemoryMap& map) {
  const unsigned pes = placement.torus.pes();
  pe_bytes.resize(pes);
  for (unsigned pe = 0; pe < pes; ++pe) {
    const PeLayout layout = lay_out(mesh, placement, static_cast<protocol::PeNumber>(pe), stage, parameters, map);
    const std::uint64_t bytes = layout.end - protocol::kLocalMemoryBase;
    const bool is_most = bytes > most();
    pe_bytes[pe] = std::max(pe_bytes[pe], bytes);
    if (!is_most) continue;
    fullest = static_cast<protocol::PeNumber>(pe);
    fullest_stage = stage;
    fullest_stores = layout.bytes;
    fullest_stores.push_back({"image", Lessened::nothing, map.stores_begin - protocol::kLocalMemoryBase});
  }
}

MemoryNeed memory_need(const Mesh& mesh, const Placement& radiosity, const Placement& ray_tracing,
                       const StageParameters& parameters, const MemoryMap& map) {
  MemoryNeed need;
  need.add(mesh, radiosity, Stage::radiosity, parameters, map);
  need.add(mesh, ray_tracing, Stage::ray_tracing, parameters, map);
  return need;
}

std::uint64_t MemoryNeed::lessened_by(Lessened by) const {
  std::uint64_t bytes = 0;
  for (const StoreBytes& store : fullest_stores) bytes += store.by == by ? store.bytes : 0;
  return bytes;
}

std::string MemoryNeed::refusal(std::uint64_t available) const {
  std::vector<StoreBytes> stores = fullest_stores;
  std::ranges::sort(stores, [this](const StoreBytes& a, const StoreBytes& b) {
    return std::tuple(lessened_by(b.by), a.by, b.bytes) < std::tuple(lessened_by(a.by), b.by, a.bytes);
  });
  std::string text;
  std::uint64_t rest = 0;
  std::optional<Lessened> group;
  for (const auto& [name, by, bytes] : stores) {
    if (bytes < most() / kSmallPart) {
      rest += bytes;
      continue;
    }
    text += group == by ? ", " : (group ? "; " : "") + std::string(lessened_words(by)) + ": ";
    text += std::string(name) + " " + with_commas(bytes);
    group = by;
  }
  text += "; all else: " + with_commas(rest);
  return "PE " + std::to_string(fullest) + " needs " + with_commas(most()) + " bytes for stage " +
         name_of(fullest_stage) + " (" + text + "), has " + with_commas(available);
}

std::string memory_text(std::uint64_t bytes) {
  constexpr std::uint64_t mebibyte = 1U << 20U;
  return bytes % mebibyte == 0 ? std::to_string(bytes / mebibyte) + "M" : std::to_string(bytes >> 10U) + "K";
}

std::optional<std::uint32_t> choose_memory(const MemoryNeed& need, std::optional<std::uint32_t> given) {
  if (given) return need.most() <= *given ? given : std::nullopt;
  for (std::uint32_t bytes = protocol::kDefaultLocalMemory; bytes <= protocol::kLargestLocalMemory; bytes *= 2) {
    if (need.most() <= bytes) return bytes;
  }
  return std::nullopt;
}

std::string with_commas(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t at = digits.size(); at > 3;) {
    at -= 3;
    digits.insert(at, ",");
  }
  return digits;
}

}  // namespace torolux
