// SPDX-License-Identifier: MIT
// Greedy: the surfaces with the greatest load first, each to the PE that has least, of those that may keep it. Surfaces
// that only some PEs may keep go before those that all may.
#include "host_tools/layout/keepers.hpp"

#include <algorithm>
#include <queue>
#include <span>
#include <utility>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/copies.hpp"

namespace torolux {
namespace {

using protocol::PeNumber;

/// A surface to be kept: its share of all that are kept, in work and in memory.
struct Kept {
  double load;
  std::uint32_t part;
  std::span<const PeNumber> holders;  ///< PEs that have its polygon; empty: all
};

struct Keeper {
  double load;
  PeNumber pe;
  bool operator<(const Keeper& other) const {
    return load != other.load ? load > other.load : pe > other.pe;  // the least loaded is on top
  }
};

/// Polygons that are not common, with the PEs that have them.
class Holders {
 public:
  explicit Holders(const Placement& placement) {
    std::vector<std::pair<std::uint32_t, PeNumber>> all;
    for (unsigned pe = 0; pe < placement.torus.pes(); ++pe) {
      const auto& polygons = placement.polygons_of_pe[pe];
      for (std::size_t i = placement.common_polygons; i < polygons.size(); ++i) {
        all.emplace_back(polygons[i], static_cast<PeNumber>(pe));
      }
    }
    std::sort(all.begin(), all.end());
    for (const auto& [triangle, pe] : all) {
      if (triangles_.empty() || triangles_.back() != triangle) {
        triangles_.push_back(triangle);
        first_.push_back(pes_.size());
      }
      pes_.push_back(pe);
    }
    first_.push_back(pes_.size());
  }

  const std::vector<std::uint32_t>& triangles() const { return triangles_; }
  std::span<const PeNumber> of(std::size_t i) const {
    return std::span(pes_).subspan(first_[i], first_[i + 1] - first_[i]);
  }

 private:
  std::vector<std::uint32_t> triangles_;
  std::vector<std::size_t> first_;
  std::vector<PeNumber> pes_;
};

class KeeperChooser {
 public:
  KeeperChooser(const Mesh& mesh, const StageLoad& load, Placement& placement)
      : mesh_(mesh), load_(load), placement_(placement), holders_(placement), loads_(placement.torus.pes()) {}

  void choose() {
    placement_.surfaces_with_keepers.resize(loads_.size());
    list_surfaces();
    if (kept_.empty()) return;
    weigh();
    placement_.keeper_of_part.assign(mesh_.parts.size(), protocol::kNobody);
    placement_.place_of_part.resize(mesh_.parts.size());
    std::stable_sort(kept_.begin(), kept_.end(), [](const Kept& a, const Kept& b) { return a.load > b.load; });
    // Those that few may keep first: the others make up for what is uneven then.
    for (const Kept& surface : kept_) {
      if (surface.holders.empty()) continue;
      const auto lighter = [this](PeNumber a, PeNumber b) { return loads_[a] < loads_[b]; };
      give(surface, *std::min_element(surface.holders.begin(), surface.holders.end(), lighter));
    }
    std::priority_queue<Keeper> keepers;
    for (unsigned pe = 0; pe < loads_.size(); ++pe) keepers.push({loads_[pe], static_cast<PeNumber>(pe)});
    for (const Kept& surface : kept_) {
      if (!surface.holders.empty()) continue;
      const PeNumber pe = keepers.top().pe;
      keepers.pop();
      give(surface, pe);
      keepers.push({loads_[pe], pe});
    }
  }

 private:
  void list_surfaces() {
    const auto& common = placement_.polygons_of_pe.front();
    for (std::uint32_t local = 0; local < placement_.common_polygons; ++local) {
      placement_.common_surfaces_with_keepers += list_parts(common[local], {});
    }
    for (SurfaceSize& of_pe : placement_.surfaces_with_keepers) of_pe = placement_.common_surfaces_with_keepers;
    for (std::size_t i = 0; i < holders_.triangles().size(); ++i) {
      const std::uint32_t triangle = holders_.triangles()[i];
      const std::span<const PeNumber> holders = holders_.of(i);
      // Who is the only one to have it keeps it without being named.
      const SurfaceSize kept = holders.size() > 1 ? list_parts(triangle, holders) : SurfaceSize{};
      const std::uint64_t own = polygon_bytes(mesh_.triangles[triangle], protocol::Stage::ray_tracing) - kept.bytes();
      for (const PeNumber pe : holders) {
        placement_.surfaces_with_keepers[pe] += kept;
        loads_[pe] += static_cast<double>(own);
      }
    }
  }

  /// Returns what those of its parts take that are to be kept.
  SurfaceSize list_parts(std::uint32_t number, std::span<const PeNumber> holders) {
    SurfaceSize sum;
    const MeshTriangle& triangle = mesh_.triangles[number];
    if (triangle.sides == 0) return sum;
    const std::uint32_t end = triangle.first_part + protocol::triangles_of_level(triangle.patch_level);
    for (std::uint32_t part = triangle.first_part; part < end; ++part) {
      if (load_.common_surface[part]) continue;
      sum += surface_size(mesh_, part);
      kept_.push_back({0, part, holders});
    }
    return sum;
  }

  /// From here on loads are shares of all that is kept, in memory and in work.
  void weigh() {
    const std::vector<double> heat = load_.heat != nullptr ? heat_of_surfaces(*load_.heat) : std::vector<double>();
    double bytes = 0;
    double cycles = 0;
    for (const Kept& surface : kept_) {
      bytes += static_cast<double>(surface_size(mesh_, surface.part).bytes());
      if (!heat.empty()) cycles += heat[surface.part];
    }
    for (Kept& surface : kept_) {
      surface.load = static_cast<double>(surface_size(mesh_, surface.part).bytes()) / bytes;
      if (cycles > 0) surface.load += heat[surface.part] / cycles;
    }
    for (double& load : loads_) load /= bytes;
  }

  void give(const Kept& surface, PeNumber pe) {
    std::vector<std::uint32_t>& list = placement_.kept_by_pe[pe];
    placement_.keeper_of_part[surface.part] = pe;
    placement_.place_of_part[surface.part] = static_cast<std::uint32_t>(list.size());
    list.push_back(surface.part);
    loads_[pe] += surface.load;
  }

  const Mesh& mesh_;
  const StageLoad& load_;
  Placement& placement_;
  const Holders holders_;
  std::vector<Kept> kept_;
  std::vector<double> loads_;  ///< by PE; at first bytes of its own
};

}  // namespace

void keep_surfaces(const Mesh& mesh, const StageLoad& load, Placement& placement) {
  KeeperChooser(mesh, load, placement).choose();
}

}  // namespace torolux
