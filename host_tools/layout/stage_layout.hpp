// SPDX-License-Identifier: MIT
// Mesh and placement enter; leaves: how large each store of a PE is in a stage, where it lies, and how much memory the
// PEs need.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "firmware/protocol/stores.hpp"
#include "host_tools/layout/placement.hpp"

namespace torolux {

/// What all PEs are told alike. The settings' defaults are those of Quality: nothing here has one.
struct StageParameters {
  std::uint32_t seed = 0;
  std::uint32_t bounces = 0;
  std::uint32_t hemicube = 0;
  std::uint32_t shot_points = 0;
  std::uint32_t emission_points = 0;
  float points_per_quantum = 0;
  std::uint32_t apart = 0;                   ///< as protocol::StageLayout
  float dense_shot = 0, mean_radiosity = 0;  ///< likewise
  std::uint32_t gathers_emission = 0;        ///< likewise
  float pixel_scale = 0;
  float least_weight = 0;
  std::uint32_t emitters = 0;                       ///< that shadow rays aim at; 0: no shadow rays
  std::uint32_t layers = 0;                         ///< as protocol::StageLayout
  std::uint32_t sky_entries = 0, sky_openings = 0;  ///< likewise
  protocol::SkyFrame sky_frame{};
  std::uint32_t lamps = 0, lamp_values = 0, lamp_chances = 0;  ///< measured ones
  std::uint32_t pixel_samples = 0, filter_entries = 0;  ///< of the camera rays that PEs make; 0: the host makes them
};

/// The machine's side of the layout.
struct MemoryMap {
  std::uint32_t stores_begin = 0;  ///< first byte that the image leaves free
  std::uint32_t niu_slots = 0;
  std::uint32_t credits_per_pe = 0;
  std::uint32_t gather_cycles = 0, gather_records = 0;  ///< see protocol::NiuWindow::Gather
};

/// By which option a store becomes smaller.
enum class Lessened { nothing, pes, subspaces, elements, patches, texels, hemicube, samples };

struct StoreBytes {
  const char* name;
  Lessened by;
  std::uint64_t bytes;
};

struct PeLayout {
  protocol::StageLayout layout{};  ///< addresses and counts; stores in loading order, record slots last
  std::uint64_t end = 0;           ///< first byte behind the last store; beyond local memory: does not fit
  std::uint64_t load_end = 0;      ///< first byte behind the stores that are loaded (all but the record slots)
  std::vector<StoreBytes> bytes;   ///< of each store that is not empty
};

/// Numbers of the textures that the PE's polygons show, ascending.
std::vector<std::uint32_t> textures_of_pe(const Mesh& mesh, const Placement& placement, protocol::PeNumber pe);

PeLayout lay_out(const Mesh& mesh, const Placement& placement, protocol::PeNumber pe, protocol::Stage stage,
                 const StageParameters& parameters, const MemoryMap& map);

struct MemoryNeed {
  std::vector<std::uint64_t> pe_bytes;  ///< of local memory, image included, greater of both stages
  protocol::PeNumber fullest = 0;
  protocol::Stage fullest_stage = protocol::Stage::radiosity;
  std::vector<StoreBytes> fullest_stores;  ///< image included

  /// A stage with this placement.
  void add(const Mesh& mesh, const Placement& placement, protocol::Stage stage, const StageParameters& parameters,
           const MemoryMap& map);
  std::uint64_t most() const { return pe_bytes[fullest]; }
  double mean() const;
  /// Of the fullest PE's stores, those that `by` makes smaller.
  std::uint64_t lessened_by(Lessened by) const;
  /// What to say where a PE has only `available` bytes: which PE and stage, needed, available; its stores by the option
  /// that lessens them, largest first.
  std::string refusal(std::uint64_t available) const;
};

/// Scratch memory of the image beyond its own sections does not exist, so this is exact.
MemoryNeed memory_need(const Mesh& mesh, const Placement& radiosity, const Placement& ray_tracing,
                       const StageParameters& parameters, const MemoryMap& map);

/// given, or the smallest power of two from kDefaultLocalMemory that fits. Absent: it does not fit in any allowed size
/// (or not in the one given).
std::optional<std::uint32_t> choose_memory(const MemoryNeed& need, std::optional<std::uint32_t> given);

/// "4M" or "256K", as --pe-memory takes it.
std::string memory_text(std::uint64_t bytes);

/// 1234567 -> "1,234,567".
std::string with_commas(std::uint64_t value);

}  // namespace torolux
