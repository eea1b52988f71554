// SPDX-License-Identifier: MIT
// Rays per second through a room with a ball in it, with the PEs' own code compiled for this computer.
#include <benchmark/benchmark.h>

#include "tests/unit/firmware/pe/closed_rooms.hpp"

namespace torolux::test {
namespace {

void traverse_room(benchmark::State& state) {
  const auto cells = static_cast<std::uint32_t>(state.range(0));
  Case tested = room(6, {cells, cells, cells}, {1, 1, 1});
  add_ball(tested.scene, {0.5F, 0.5F, 0.5F}, 0.25F, 12, 0, true);
  std::vector<PeStores> stores = build_stores(tested.scene, protocol::Stage::ray_tracing);
  const pe::Scene scene = stores[0].scene();
  Aim aim(tested.scene, 1);
  std::vector<pe::Segment> segments;
  for (int i = 0; i < 4096; ++i) segments.push_back(aim.from(origin_in(aim, tested.low, tested.high)));
  std::size_t next = 0;
  for (auto _ : state) {
    pe::Segment segment = segments[next++ % segments.size()];
    benchmark::DoNotOptimize(pe::traverse(scene, segment));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(traverse_room)->Name("traverse/room")->Arg(1)->Arg(4)->Arg(8)->Arg(16);

void cross(benchmark::State& state) {
  const Case tested = room(1, {1, 1, 1}, {1, 1, 1});
  std::vector<PeStores> stores = build_stores(tested.scene, protocol::Stage::ray_tracing);
  const pe::Scene scene = stores[0].scene();
  Aim aim(tested.scene, 1);
  const pe::Segment segment = aim.from({0.4F, 0.5F, 0.6F});
  const pe::Shear shear(segment.origin, segment.direction, pe::Inverse(segment.direction));
  std::size_t next = 0;
  pe::Crossing crossing{};
  for (auto _ : state) {
    benchmark::DoNotOptimize(pe::cross_triangle(shear, scene.polygons[next++ % scene.polygons.size()], crossing));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(cross)->Name("intersect/triangle");

}  // namespace
}  // namespace torolux::test
