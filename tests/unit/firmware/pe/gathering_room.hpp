// SPDX-License-Identifier: MIT
// Rooms whose surfaces are evenly lit, their sides gathering on fake machines, and what their elements have found then.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "tests/unit/firmware/pe/radiosity_room.hpp"

namespace torolux::test {

inline constexpr float kReflectance = 0.6F;
/// Flux [quanta] of an area of 1.
inline constexpr std::array<double, 3> kEven = {0x1p44, 0x1p42, 0x1p40};

struct Gathered {
  protocol::Flux flux;  ///< incident, by shots
  protocol::Flux found;
  std::uint32_t points;
  bool operator==(const Gathered&) const = default;
};
/// By global patch and side, of each element.
using GatheredBySide = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Gathered>>;

inline std::vector<Gathered> gathered_by(const FakeMachine& machine, std::uint16_t pe, const protocol::Patch& patch,
                                         std::uint32_t side) {
  const protocol::StageLayout& layout = machine.stores[pe].layout;
  const auto elements = machine.store<protocol::Element>(pe, layout.elements);
  const std::uint32_t first = machine.stores[pe].sides[patch.side[side]].first_element;
  std::vector<Gathered> out;
  for (std::uint32_t e = 0; e < patch.elements; ++e) {
    const protocol::Element& element = elements[first + e];
    out.push_back({element.flux, element.gathered, element.points});
  }
  return out;
}

/// The number, which seeds the random numbers, is the same wherever the patch is. Returns how many rays were made.
inline std::uint32_t gather_side(FakeMachine& machine, std::uint16_t pe, std::uint32_t patch, std::uint32_t side,
                                 std::uint32_t points, std::uint32_t credits = 100) {
  const std::uint32_t number = 1000 + 2 * machine.stores[pe].patches[patch].number + side;
  return machine.shoot(pe, {{points, 0, 0}, patch, side, protocol::ShotKind::gathering, number}, credits);
}

/// All sides look around, with so many points for each element.
inline GatheredBySide gather_all(FakeMachine& machine, std::uint32_t points, std::uint32_t credits = 100) {
  for (std::uint16_t p = 0; p < machine.pes.size(); ++p) {
    const auto& patches = machine.stores[p].patches;
    for (std::uint32_t patch = 0; patch < patches.size(); ++patch) {
      for (std::uint32_t side = 0; side < 2; ++side) {
        if (patches[patch].side[side] == protocol::kNoSide) continue;
        gather_side(machine, p, patch, side, points * patches[patch].elements, credits);
      }
    }
  }
  GatheredBySide out;
  for (std::uint16_t p = 0; p < machine.pes.size(); ++p) {
    for (const protocol::Patch& patch : machine.stores[p].patches) {
      for (std::uint32_t side = 0; side < 2; ++side) {
        if (patch.side[side] != protocol::kNoSide) out[{patch.number, side}] = gathered_by(machine, p, patch, side);
      }
    }
  }
  return out;
}

inline std::uint64_t gather_rays(FakeMachine& machine) {
  std::uint64_t sum = 0;
  for (std::uint16_t p = 0; p < machine.pes.size(); ++p) sum += machine.tally(p).gather_rays;
  return sum;
}

/// Elements get flux by their area, those of these polygons' sides only.
template <class IsLit>
void light_evenly(PeStores& stores, const IsLit& is_lit) {
  for (const protocol::Patch& patch : stores.patches) {
    for (const std::uint32_t side : patch.side) {
      if (side == protocol::kNoSide) continue;
      protocol::PatchSide& of = stores.sides[side];
      of.incident = {1, 1, 1};  // not dark
      for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
        const protocol::Facet& facet = stores.facets[f];
        if (!is_lit(facet.polygon)) continue;
        protocol::Element& element = stores.elements[of.first_element + facet.element];
        for (std::size_t c = 0; c < 3; ++c)
          element.flux[c] = static_cast<std::int64_t>(kEven[c] * static_cast<double>(facet.lit_area));
        add_to(of.incident, element.flux);
      }
    }
  }
}

inline constexpr auto kAll = [](std::uint32_t) { return true; };

template <class IsLit>
void begin_evenly(FakeMachine& machine, const TestScene& scene, const IsLit& is_lit, std::uint32_t niu_slots = 64) {
  machine.load(scene, protocol::Stage::radiosity, niu_slots, 1,
               [&](PeStores& stores) { light_evenly(stores, is_lit); });
  for (std::uint16_t p = 0; p < machine.pes.size(); ++p) machine.message(p, protocol::MessageKind::begin);
  machine.run();
}

/// A closed room, its walls cut into patches and elements of different sizes.
inline TestScene closed_room(std::uint32_t pes, std::array<std::uint32_t, 3> cells) {
  TestScene s;
  s.pes = pes;
  s.cells = cells;
  s.apart = protocol::kTurned;
  s.materials = {diffuse_material(kReflectance)};
  add_room(s, {0.1F, 0, 0}, {1, 0.75F, 0.5F}, 2, 0);
  for (std::size_t i = 0; i < s.polygons.size(); ++i) {
    s.polygons[i].patch_level = i % 3 == 0 ? 1 : 0;
    s.polygons[i].element_level = static_cast<std::uint8_t>(1 + i % 2);
  }
  return s;
}

}  // namespace torolux::test
