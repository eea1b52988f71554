// SPDX-License-Identifier: MIT
// Proves, with whole PEs and fake NIUs: tiles give the very picture that rays of the host give, wherever the eye is and
// however many PEs and credits there are; rays that see nothing of the scene take no credit; tiles that cannot be are
// refused.
#include <gtest/gtest.h>

#include <functional>

#include "firmware/protocol/first_cell.hpp"
#include "tests/unit/firmware/pe/fake_machine.hpp"

namespace torolux::test {
namespace {

using protocol::MessageKind;
using protocol::RayRecord;
using protocol::Stage;
using protocol::Tile;

constexpr std::uint32_t kWidth = 20;
constexpr std::uint32_t kHeight = 12;

/// A ball of glass, a mirror's and one that shines before a wall: what a ray sees depends on where it goes.
TestScene open_scene(std::uint32_t pes) {
  TestScene s;
  s.pes = pes;
  s.cells = {4, 3, 5};
  s.materials = {diffuse_material(0.5F, 0.25F), mirror_material(0.5F), glass_material(1.5F, 1.0F),
                 diffuse_material(0.25F, 1)};
  add_wall(s, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 3, 0);
  add_ball(s, {0.3F, 0.4F, 0.6F}, 0.2F, 5, 2, true);
  add_ball(s, {0.7F, 0.7F, 0.6F}, 0.2F, 5, 3, true);
  add_ball(s, {0.6F, 0.2F, 0.3F}, 0.15F, 5, 1, true);
  for (TestPolygon& p : s.polygons) {
    if (protocol::is_specular(s.materials[p.material].kind)) p.sides = 0;
  }
  aim_at(s, 3);  // shadow rays, whose random numbers depend on the sample
  return s;
}

/// Upright, along z.
protocol::CameraView view_from(const protocol::Vec3f& eye, float z) {
  protocol::CameraView view{};
  view.eye = eye;
  view.forward = {0, 0, z};
  view.right = {0.08F, 0, 0};
  view.down = {0, -0.08F, 0};
  view.width = kWidth;
  view.height = kHeight;
  view.samples = 3;
  view.seed = 5;
  view.filter_bits = 1;
  return view;
}

const std::vector<protocol::SamplePlace> kPlaces = {{0, 0x8000'0000}, {0x6000'0000, 0x1234'5678}, {0xF000'0000, 77}};
const std::vector<float> kBox = {-0.5F, 0, 0.5F};

void begin(FakeMachine& machine, const TestScene& scene, const protocol::CameraView& view) {
  machine.load(scene, Stage::ray_tracing, 64, 1.5F, [&view](PeStores& s) {
    s.layout.view = view;
    s.sample_places = kPlaces;
    s.filter = kBox;
  });
  for (std::uint16_t p = 0; p < machine.pes.size(); ++p) machine.message(p, MessageKind::begin);
  machine.run();
  ASSERT_EQ(machine.take(MessageKind::ready).size(), machine.pes.size());
}

/// With a lens, which may stand across the object space's border.
protocol::CameraView lens_from(const protocol::Vec3f& eye, float radius) {
  protocol::CameraView view = view_from(eye, 1);
  view.lens_right = {radius, 0, 0};
  view.lens_down = {0, -0.7071F * radius, 0.7071F * radius};
  view.inverse_focus = 1.5F;
  return view;
}

/// As the host of the paper's scheme makes them; how many there are.
std::uint32_t trace_from_host(FakeMachine& machine, const TestScene& scene, const protocol::CameraView& view) {
  const protocol::GridShape grid{machine.stores[0].layout.cells, machine.stores[0].layout.cell_size};
  std::uint32_t sent = 0;
  for (std::uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
    const protocol::CameraPixel from = protocol::camera_pixel(view, pixel % kWidth, pixel / kWidth);
    for (std::uint32_t sample = 0; sample < view.samples; ++sample) {
      RayRecord r{};
      r.origin = view.eye;
      r.direction = protocol::camera_direction(view, from, kPlaces[sample], kBox);
      if (protocol::has_lens(view)) {
        const protocol::LensRay ray = protocol::lens_ray(view, from, sample, kPlaces[sample], kBox);
        r.origin = ray.origin;
        r.direction = ray.direction;
      }
      const auto start = protocol::first_cell(grid, r.origin, r.direction);
      if (!start) continue;
      r.weight.fill(1.0F / 3.0F);
      r.place = protocol::cell_code(start->cell[0], start->cell[1], start->cell[2]);
      r.polygon = r.target = protocol::kNoPolygon;
      r.key = protocol::camera_key(from, sample);
      r.pixel = pixel;
      r.flags = start->flags;
      r.sample = static_cast<std::uint16_t>(sample);
      const auto* bytes = reinterpret_cast<const std::byte*>(&r);
      const std::uint16_t pe = scene.pe_of(start->cell[0], start->cell[1], start->cell[2]);
      machine.send({protocol::kHost, pe, {{bytes, bytes + sizeof(r)}}});
      ++sent;
    }
  }
  machine.run();
  EXPECT_EQ(machine.take_credits(), sent);
  return sent;
}

struct Made {
  std::uint32_t tiles = 0, rays = 0;
};

/// Deals the whole picture in tiles of 7 x 5, in turn to all PEs, and grants each PE that asks `credits`.
Made trace_tiles(FakeMachine& machine, std::uint32_t credits) {
  std::vector<Tile> tiles;
  for (std::uint32_t row = 0; row < kHeight; row += 5) {
    for (std::uint32_t column = 0; column < kWidth; column += 7) {
      tiles.push_back({static_cast<std::uint16_t>(column), static_cast<std::uint16_t>(row),
                       static_cast<std::uint16_t>(std::min(7U, kWidth - column)),
                       static_cast<std::uint16_t>(std::min(5U, kHeight - row))});
    }
  }
  Made made;
  std::vector<std::uint32_t> held(machine.pes.size());
  std::size_t dealt = 0;
  std::uint32_t out = 0;
  while (made.tiles < tiles.size()) {
    for (std::uint16_t p = 0; p < held.size(); ++p) {
      for (; held[p] < protocol::kTilePlaces && dealt < tiles.size(); ++held[p]) {
        machine.message(p, MessageKind::tile, tiles[dealt++]);
      }
    }
    machine.run();
    const auto needs = machine.take(MessageKind::need);
    for (const HostMessage& need : needs) machine.message(need.source, MessageKind::grant, protocol::Grant{credits});
    out += static_cast<std::uint32_t>(needs.size()) * credits;
    machine.run();
    std::uint32_t done = 0;
    for (const HostMessage& message : machine.take(MessageKind::work_done)) {
      const auto part = message.as<protocol::WorkDone>();
      held.at(message.source) -= part.points;
      done += part.points;
      made.rays += part.records;
    }
    made.tiles += done;
    if (needs.empty() && done == 0) {
      ADD_FAILURE() << "all sleep, with work left";
      return made;
    }
  }
  for (const HostMessage& need : machine.take(MessageKind::need)) {
    machine.message(need.source, MessageKind::grant, protocol::Grant{credits});
    out += credits;
  }
  machine.run();
  EXPECT_EQ(machine.take_credits(), out) << "credits lost or made";
  return made;
}

TEST(Tiles, GiveThePictureThatRaysOfTheHostGive) {
  for (const auto& view : {view_from({0.45F, 0.5F, -0.7F}, 1), view_from({0.45F, 0.5F, 0.05F}, 1),
                           lens_from({0.45F, 0.5F, -0.7F}, 0.2F), lens_from({0.45F, 0.5F, 0.05F}, 0.2F)}) {
    const TestScene scene = open_scene(1);
    FakeMachine wanted(1);
    begin(wanted, scene, view);
    const std::uint32_t rays = trace_from_host(wanted, scene, view);
    ASSERT_GT(wanted.pixels.size(), 50U) << "there is something to see";
    for (const std::uint32_t pes : {1U, 2U, 7U}) {
      for (const std::uint32_t credits : {1U, 5U, 200U}) {
        FakeMachine machine(pes);
        begin(machine, open_scene(pes), view);
        const Made made = trace_tiles(machine, credits);
        EXPECT_EQ(made.rays, rays);
        EXPECT_EQ(machine.pixels, wanted.pixels) << pes << " PEs, " << credits << " credits";
        for (const auto& p : machine.pes) EXPECT_EQ(p->free_niu_slots(), p->niu_slots());
      }
    }
  }
}

TEST(Tiles, RaysThatMissTheObjectSpaceTakeNoCredit) {
  FakeMachine machine(1);
  begin(machine, open_scene(1), view_from({0.45F, 0.5F, -0.7F}, -1));
  EXPECT_EQ(trace_tiles(machine, 1).rays, 0U);
  EXPECT_TRUE(machine.pixels.empty());
}

TEST(Tiles, ThatCannotBeAreRefused) {
  const auto view = view_from({0.45F, 0.5F, 0.05F}, 1);
  for (const Tile& tile : {Tile{0, 0, 0, 1}, Tile{0, 0, 1, 0}, Tile{15, 0, 6, 1}, Tile{0, 8, 1, 5},
                           Tile{65535, 0, 1, 1}, Tile{0, 0, 65535, 1}}) {
    FakeMachine machine(1);
    begin(machine, open_scene(1), view);
    machine.message(0, MessageKind::tile, tile);
    EXPECT_THROW(machine.run(), PeFailed);
  }
  FakeMachine machine(1);
  begin(machine, open_scene(1), view);
  for (std::uint32_t i = 0; i <= protocol::kTilePlaces; ++i) machine.message(0, MessageKind::tile, Tile{0, 0, 2, 2});
  EXPECT_THROW(machine.run(), PeFailed) << "more than there are places";
  FakeMachine without(1);
  without.begin(open_scene(1), Stage::ray_tracing);
  without.message(0, MessageKind::tile, Tile{0, 0, 2, 2});
  EXPECT_THROW(without.run(), PeFailed) << "it has no camera";
}

TEST(Tiles, CamerasThatCannotBeAreRefused) {
  const std::vector<std::function<void(PeStores&)>> changes = {
      [](PeStores& s) { s.layout.view.samples = 2; },     [](PeStores& s) { s.filter.pop_back(); },
      [](PeStores& s) { s.layout.view.filter_bits = 0; }, [](PeStores& s) { s.layout.view.filter_bits = 32; },
      [](PeStores& s) { s.layout.view.width = 0; },       [](PeStores& s) { s.layout.view.height = 65536; },
  };
  for (std::size_t i = 0; i <= changes.size(); ++i) {
    FakeMachine machine(1);
    const auto load = [&] {
      machine.load(open_scene(1), Stage::ray_tracing, 64, 1, [&](PeStores& s) {
        s.layout.view = view_from({0.45F, 0.5F, 0.05F}, 1);
        s.sample_places = kPlaces;
        s.filter = kBox;
        if (i > 0) changes[i - 1](s);
      });
    };
    if (i == 0) {
      EXPECT_NO_THROW(load());
    } else {
      EXPECT_THROW(load(), PeFailed) << i;
    }
  }
}

void send_view(FakeMachine& machine, const protocol::View& view) {
  for (std::uint16_t p = 0; p < machine.pes.size(); ++p) machine.message(p, MessageKind::view, view);
}

TEST(Views, PassesAddUpToThePictureOfAllSamples) {
  const auto first = view_from({0.45F, 0.5F, -0.7F}, 1);
  const auto other = view_from({0.45F, 0.5F, 0.05F}, 1);
  FakeMachine wanted(2);
  begin(wanted, open_scene(2), other);
  const Made all = trace_tiles(wanted, 5);
  for (const std::uint32_t step : {1U, 2U}) {
    FakeMachine machine(2);
    begin(machine, open_scene(2), first);
    trace_tiles(machine, 5);
    machine.pixels.clear();
    std::uint32_t rays = 0;
    for (const auto& [begin_at, count] : {std::pair{0U, 1U}, std::pair{1U, 2U}}) {
      send_view(machine, {other, begin_at, count, step});
      rays += trace_tiles(machine, 5).rays;
    }
    EXPECT_EQ(rays, all.rays);
    EXPECT_EQ(machine.pixels, wanted.pixels) << step;
  }
}

TEST(Views, ThatCannotBeAreRefused) {
  const auto view = view_from({0.45F, 0.5F, 0.05F}, 1);
  auto samples = view;
  samples.samples = 4;
  auto width = view;
  width.width = 0;
  for (const protocol::View& bad :
       {protocol::View{view, 0, 0, 1}, protocol::View{view, 3, 1, 1}, protocol::View{view, 1, 3, 1},
        protocol::View{view, 0, 0xFFFF'FFFF, 1}, protocol::View{view, 0, 1, 3}, protocol::View{samples, 0, 1, 1},
        protocol::View{width, 0, 1, 1}}) {
    FakeMachine machine(1);
    begin(machine, open_scene(1), view);
    send_view(machine, bad);
    EXPECT_THROW(machine.run(), PeFailed) << bad.first << " " << bad.count << " " << bad.step;
  }
  FakeMachine machine(1);
  begin(machine, open_scene(1), view);
  machine.message(0, MessageKind::tile, Tile{0, 0, 2, 2});
  send_view(machine, {view, 0, 1, 1});
  EXPECT_THROW(machine.run(), PeFailed) << "it has a tile";
}

}  // namespace
}  // namespace torolux::test
