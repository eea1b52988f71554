// SPDX-License-Identifier: MIT
// First without copies; then a bisection for the most copies that fit, what is worth most heat per byte first. Where
// even none fit, again with memory more evenly shared.
#include "host_tools/setup/placements.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/copies.hpp"
#include "host_tools/scene/keep_on.hpp"
#include "host_tools/setup/camera_sample.hpp"
#include "host_tools/setup/sample_heat.hpp"

namespace torolux {
namespace {

using protocol::Stage;

/// For a PE's own memory in `balanced`, where it does not fit otherwise.
constexpr double kTightMemory = 1.02;
/// A PE's part of all heat so many times: with more of it in one cell, that PE would keep the others waiting. With less
/// each copy counts for more if it goes by heat per byte (the flat on 1,024 PEs of 1 MiB: 1, 4, 16 and no limit take
/// 1.62e8, 1.45e8, 1.80e8, 1.80e8 cycles).
constexpr double kSharesToBear = 4;
/// Steps of the search for the most copies that fit.
constexpr int kSearchSteps = 12;

class Chooser {
 public:
  Chooser(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
          const Mesh& mesh, const StageParameters& parameters, const MemoryMap& map)
      : machine_(machine), mesh_(mesh), parameters_(parameters), map_(map) {
    choice_ = {{machine.columns, machine.rows}, machine.subspaces, machine.allocation, machine.scheme, machine.empty};
    if (!choice_.subspaces && machine.scheme == Scheme::spread) {
      choice_.subspaces =
          spread_cells(mesh.space, mesh.triangles.size(), machine.pe_memory.value_or(protocol::kDefaultLocalMemory));
    }
    lists_ = list_cells(mesh, make_grid(mesh.space, choice_.subspaces, mesh.triangles.size(), choice_.torus.pes()));
    const bool needs_heat = for_each_stage() || machine.allocation == "balanced";
    if (choice_.torus.pes() > 1 && needs_heat) {
      const Placement whole =
          make_placement(mesh, lists_, {{1, 1}, std::nullopt, "modulo", machine.scheme, machine.empty}, {});
      look_for_interruption();
      radiosity_heat_ = sample_radiosity_heat(scene, mesh, whole, quality.bounces);
      if (for_each_stage()) {
        const CameraRays rays(camera, mesh.space, quality.width, quality.height, PixelSamples(quality, parameters.seed),
                              parameters.seed);
        ray_heat_ = sample_ray_heat(scene, mesh, whole, rays, camera_sample_choice(quality, machine, parameters));
      }
    }
  }

  Placements choose() const { return for_each_stage() ? one_for_each() : one_for_both(); }

 private:
  bool for_each_stage() const { return machine_.scheme == Scheme::spread || machine_.replicate != 0.0; }

  Placements one_for_both() const {
    Placements result;
    result.radiosity = place(Stage::radiosity, {}, {}, kMostMemory);
    result.ray_tracing = result.radiosity;
    choose_memory_for(result);
    return result;
  }

  Placements one_for_each() const {
    Placements result;
    for (const double most_memory : {kMostMemory, kTightMemory}) {
      result.radiosity = place(Stage::radiosity, {}, {}, most_memory);
      result.ray_tracing = place(Stage::ray_tracing, {}, {}, most_memory);
      choose_memory_for(result);
      const std::uint32_t memory = result.memory.value_or(machine_.pe_memory.value_or(protocol::kLargestLocalMemory));
      copy(Stage::ray_tracing, memory, most_memory, result.ray_tracing, result.ray_tracing_copies);
      if (!result.memory) choose_memory_for(result);
      if (!result.memory) continue;
      copy(Stage::radiosity, memory, most_memory, result.radiosity, result.radiosity_copies);
      choose_memory_for(result);
      break;
    }
    return result;
  }

  const Heat& heat(Stage stage) const { return stage == Stage::radiosity ? radiosity_heat_ : ray_heat_; }

  Placement place(Stage stage, std::vector<bool> common, std::vector<bool> surfaces, double most_memory) const {
    look_for_interruption();
    const Heat& of_stage = heat(stage);
    return make_placement(
        mesh_, lists_, choice_,
        {stage, of_stage.empty() ? nullptr : &of_stage, std::move(common), std::move(surfaces), most_memory});
  }

  /// Without copies it is chosen, if not given; with them there is one.
  void choose_memory_for(Placements& result) const {
    result.need = memory_need(mesh_, result.radiosity, result.ray_tracing, parameters_, map_);
    result.memory = choose_memory(result.need, result.memory ? result.memory : machine_.pe_memory);
  }

  /// By polygon, the share of the PEs that do not have it.
  std::vector<double> lacking(const Placement& placement) const {
    std::vector<double> share(mesh_.triangles.size(), placement.torus.pes());
    for (const auto& polygons : placement.polygons_of_pe) {
      for (const std::uint32_t t : polygons) share[t] -= 1;
    }
    for (double& of_polygon : share) of_polygon /= placement.torus.pes();
    return share;
  }

  MemoryNeed need_of(const Placement& placement, Stage stage) const {
    MemoryNeed need;
    need.add(mesh_, placement, stage, parameters_, map_);
    return need;
  }

  /// The search for the most copies that fit one stage: what is worth more is copied first.
  class CopySearch {
   public:
    /// placement, copies: of the stage; take the best that has been found.
    CopySearch(const Chooser& chooser, Stage stage, std::uint32_t memory, double most_memory, Placement& placement,
               StageCopies& copies)
        : chooser_(chooser),
          stage_(stage),
          memory_(memory),
          most_memory_(most_memory),
          placement_(placement),
          copies_(copies) {
      const std::vector<double> cells = heat_of_cells(chooser.heat(stage));
      const double all = std::accumulate(cells.begin(), cells.end(), 0.0);
      order_ = copy_order(chooser.mesh_, chooser.lists_.polygons, stage, cells, chooser.lacking(placement),
                          kSharesToBear * all / chooser.choice_.torus.pes());
      if (stage == Stage::ray_tracing) {
        surfaces_ = worth_of_surfaces(chooser.mesh_, heat_of_surfaces(chooser.heat(stage)));
      }
    }

    void run() {
      if (fits_with(0, 0)) return;
      double least_of_cells = kNone;
      if (stage_ == Stage::ray_tracing && chooser_.need_of(placement_, stage_).most() > memory_) {
        const auto found = shapes_that_fit();
        if (!found) return;
        least_of_cells = *found;
      }
      bisect(least_of_cells);
    }

   private:
    static constexpr double kNone = std::numeric_limits<double>::infinity();

    /// Copies of all that is worth at least so much. True: it fits, and is the best so far.
    bool fits_with(double least_of_cells, double least_of_surfaces) {
      const std::size_t count = order_.worth_at_least(least_of_cells);
      if (count == 0 && surfaces_.empty()) return false;
      StageCopies chosen{count, count > 0 ? order_.bytes[count - 1] : 0};
      std::vector<bool> everywhere(surfaces_.size());
      for (std::uint32_t part = 0; part < surfaces_.size(); ++part) {
        everywhere[part] = surfaces_[part] >= least_of_surfaces && surfaces_[part] > 0;
      }
      Placement with = chooser_.place(stage_, order_.first(count, chooser_.lists_.grid.count()), std::move(everywhere),
                                      most_memory_);
      if (!surfaces_.empty()) chosen.bytes += chooser_.bytes_of_common_surfaces(with);
      if (static_cast<double>(chosen.bytes) > chooser_.machine_.replicate.value_or(1) * memory_) return false;
      if (chooser_.need_of(with, stage_).most() > memory_ || most_kept(with) > protocol::kMostKept) return false;
      placement_ = std::move(with);
      for (const auto& kept : placement_.kept_by_pe) chosen.kept += kept.size();
      copies_ = chosen;
      return true;
    }

    /// Where whole surfaces do not fit with all who own a cell of theirs, copies of shapes alone may: what the least
    /// one copied is worth then.
    std::optional<double> shapes_that_fit() {
      std::size_t count = order_.cells.size();
      const auto worth = [&] { return count > 0 ? order_.worth[count - 1] : kNone; };
      while (!fits_with(worth(), kNone)) {
        if (count == 0) return std::nullopt;
        count = count * 3 / 4;
      }
      return worth();
    }

    /// Between none and all, by one worth for cells and surfaces; cells of `least_of_cells` are copied anyway.
    void bisect(double least_of_cells) {
      std::vector<double> worths = order_.worth;
      std::ranges::copy_if(surfaces_, std::back_inserter(worths), [](double worth) { return worth > 0; });
      std::sort(worths.rbegin(), worths.rend());
      std::size_t enough = 0;
      std::size_t too_many = worths.size();
      for (int step = 0; step < kSearchSteps && enough + 1 < too_many; ++step) {
        const std::size_t middle = enough + (too_many - enough) / 2;
        (fits_with(std::min(worths[middle], least_of_cells), worths[middle]) ? enough : too_many) = middle;
      }
    }

    const Chooser& chooser_;
    Stage stage_;
    std::uint32_t memory_;
    double most_memory_;
    Placement& placement_;
    StageCopies& copies_;
    CopyOrder order_;
    std::vector<double> surfaces_;  ///< what each is worth; empty: they are not copied apart
  };

  /// Puts as many copies into `placement` as fit.
  void copy(Stage stage, std::uint32_t memory, double most_memory, Placement& placement, StageCopies& copies) const {
    if (choice_.torus.pes() == 1 || heat(stage).empty()) return;
    CopySearch(*this, stage, memory, most_memory, placement, copies).run();
  }

  /// Of those without a keeper.
  std::uint64_t bytes_of_common_surfaces(const Placement& placement) const {
    std::uint64_t bytes = 0;
    for (std::uint32_t local = 0; local < placement.common_polygons; ++local) {
      const MeshTriangle& triangle = mesh_.triangles[placement.polygons_of_pe.front()[local]];
      bytes += polygon_bytes(triangle, Stage::ray_tracing) - shape_bytes(mesh_, triangle, Stage::ray_tracing);
    }
    return bytes - placement.common_surfaces_with_keepers.bytes();
  }

  static std::size_t most_kept(const Placement& placement) {
    std::size_t most = 0;
    for (const auto& kept : placement.kept_by_pe) most = std::max(most, kept.size());
    return most;
  }

  const MachineChoice& machine_;
  const Mesh& mesh_;
  const StageParameters& parameters_;
  const MemoryMap& map_;
  PlacementChoice choice_;
  CellLists lists_;
  Heat radiosity_heat_, ray_heat_;
};

}  // namespace

Placements choose_placements(const Scene& scene, const Camera& camera, const Quality& quality,
                             const MachineChoice& machine, const Mesh& mesh, const StageParameters& parameters,
                             const MemoryMap& map) {
  return Chooser(scene, camera, quality, machine, mesh, parameters, map).choose();
}

}  // namespace torolux
