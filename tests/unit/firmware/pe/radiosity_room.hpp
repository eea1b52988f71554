// SPDX-License-Identifier: MIT
// A room for the radiosity stage, its lamp, and what the stage leaves on all PEs, summed.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "tests/unit/firmware/pe/fake_machine.hpp"

namespace torolux::test {

inline constexpr std::int64_t kEmitted = std::int64_t{1} << 40U;

/// A room with a lamp, a mirror ball and a glass ball, all polygons with elements, both sides of the lamp. Its floor is
/// glossy, with a lobe so wide that a share of it may be more than came.
inline TestScene room_with_balls(std::uint32_t pes, std::array<std::uint32_t, 3> cells) {
  TestScene s;
  s.pes = pes;
  s.cells = cells;
  s.hemicube_size = 8;
  s.points = 2;
  s.materials = {diffuse_material(0.7F), diffuse_material(0.3F, 1), mirror_material(0.9F), glass_material(1.5F, 0.95F),
                 glossy_material(0.2F, 0.7F, 1)};
  add_room(s, {0, 0, 0}, {1, 1, 1}, 2, 0);
  for (std::size_t i = 0; i < 8; ++i) s.polygons[i].material = 4;  // z low
  for (TestPolygon& p : s.polygons) p.element_level = 2;
  for (std::size_t i = 0; i < s.polygons.size(); i += 3) s.polygons[i].patch_level = 1;
  add_wall(s, {0.4F, 0.4F, 0.97F}, {0, 0.2F, 0}, {0.2F, 0, 0}, 1, 1);
  s.polygons.back().sides = 3;
  s.polygons.back().element_level = s.polygons.back().patch_level = 1;
  add_ball(s, {0.3F, 0.3F, 0.3F}, 0.2F, 6, 2, true);
  add_ball(s, {0.7F, 0.6F, 0.4F}, 0.2F, 6, 3, true);
  for (TestPolygon& p : s.polygons) {
    if (p.material == 2 || p.material == 3) p.sides = 0;
  }
  return s;
}

/// The same without mirror, glass and gloss.
inline TestScene diffuse_room(std::uint32_t pes, std::array<std::uint32_t, 3> cells) {
  TestScene scene = room_with_balls(pes, cells);
  scene.polygons.erase(scene.polygons.begin() + 50, scene.polygons.end());  // the balls
  scene.materials[4] = diffuse_material(0.2F);
  return scene;
}

/// Of either room, right under the lamp.
inline void add_pane(TestScene& scene) {
  scene.materials.push_back(pane_material(1.5F, 0.5F));
  const std::size_t panes = scene.polygons.size();
  add_wall(scene, {0, 0, 0.9F}, {0, 1, 0}, {1, 0, 0}, 1, 5);
  for (std::size_t i = panes; i < scene.polygons.size(); ++i) scene.polygons[i].sides = 0;
}

/// Sets all emission of the lamp, unevenly by channel.
inline void light_lamp(PeStores& stores) {
  for (const protocol::Patch& patch : stores.patches) {
    if (stores.polygons[stores.facets[patch.first_facet].polygon].material == 1 && patch.side[0] != protocol::kNoSide) {
      stores.sides[patch.side[0]].emission = {kEmitted, kEmitted / 3, 12345};
    }
  }
}

struct RoomOutcome {
  /// By global patch and side: incident flux, and of each element its flux and what of it is kept apart.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<protocol::Flux>> flux;
  protocol::Flux specular{}, glossy{}, escaped{}, cut_off{}, back{};
  std::int64_t carried = 0;  ///< by all shots, R + G + B
  std::uint64_t records = 0;
};

inline void add_to(protocol::Flux& sum, const protocol::Flux& f) {
  for (std::size_t c = 0; c < 3; ++c) sum[c] += f[c];
}

inline void gather(FakeMachine& machine, RoomOutcome& out) {
  for (std::uint16_t p = 0; p < machine.pes.size(); ++p) {
    const auto tally = machine.tally(p);
    add_to(out.specular, tally.absorbed_specular);
    add_to(out.glossy, tally.reflected_glossy);
    add_to(out.escaped, tally.escaped);
    add_to(out.cut_off, tally.cut_off);
    add_to(out.back, tally.back_side);
    const auto& stores = machine.stores[p];
    const auto sides = machine.store<protocol::PatchSide>(p, stores.layout.patch_sides);
    const auto elements = machine.store<protocol::Element>(p, stores.layout.elements);
    for (const protocol::Patch& patch : stores.patches) {
      for (std::uint32_t side = 0; side < 2; ++side) {
        if (patch.side[side] == protocol::kNoSide) continue;
        const protocol::PatchSide& s = sides[patch.side[side]];
        auto& list = out.flux[{patch.number, side}];
        protocol::Flux sum{};
        list.push_back(s.incident);
        for (std::uint32_t e = 0; e < patch.elements; ++e) {
          list.push_back(elements[s.first_element + e].flux);
          list.push_back(elements[s.first_element + e].apart);
          add_to(sum, elements[s.first_element + e].flux);
        }
        EXPECT_EQ(sum, s.incident) << "patch " << patch.number;
      }
    }
  }
}

/// Loads the room, its lamp lit.
inline void begin_room(FakeMachine& machine, const TestScene& scene, std::uint32_t niu_slots) {
  machine.load(scene, protocol::Stage::radiosity, niu_slots, 1, light_lamp);
  for (std::uint16_t p = 0; p < scene.pes; ++p) machine.message(p, protocol::MessageKind::begin);
  machine.run();
}

/// Shoots the best side of the whole machine `shots` times, as a host would, one at a time.
inline void shoot_best(FakeMachine& machine, std::uint32_t shots, std::uint32_t credits, RoomOutcome& out) {
  for (std::uint32_t shot = 0; shot < shots; ++shot) {
    std::uint16_t where = 0;
    protocol::Candidate best{};
    for (std::uint16_t p = 0; p < machine.pes.size(); ++p) {
      for (const auto& c : machine.select(p, 1, 0)) {
        if (c.unshot > best.unshot || (c.unshot == best.unshot && c.number < best.number)) {
          best = c;
          where = p;
        }
      }
    }
    if (best.unshot == 0) break;
    out.carried += best.unshot;
    out.records += machine.shoot(where, {best.amount, best.patch, best.side, best.kind, shot}, credits);
  }
}

/// All of that, and what it leaves.
RoomOutcome radiate(const TestScene& scene, std::uint32_t shots, std::uint32_t niu_slots, std::uint32_t credits,
                    bool points_travel = true, std::uint32_t parts = 1) {
  FakeMachine machine(scene.pes);
  machine.points_travel = points_travel;
  machine.shoot_in_parts = parts;
  begin_room(machine, scene, niu_slots);
  RoomOutcome out;
  shoot_best(machine, shots, credits, out);
  gather(machine, out);
  machine.stop();
  return out;
}

}  // namespace torolux::test
