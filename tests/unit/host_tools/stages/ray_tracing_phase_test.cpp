// SPDX-License-Identifier: MIT
// The host's conduct of the ray tracing stage: which rays it makes in which order, where it sends them, and that no
// more are out than there are credits.
#include "host_tools/stages/ray_tracing_phase.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/host_tools/stages/fake_port.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux::test {
namespace {

using protocol::MessageKind;
using protocol::RayRecord;

constexpr std::uint32_t kWidth = 12;
constexpr std::uint32_t kHeight = 9;

class RayTracingPhaseTest : public testing::Test {
 protected:
  RayTracingPhase phase(std::uint64_t credits, const Vec3d& eye = {0.5, 0.5, 0.05},
                        const Vec3d& look_at = {0.5, 0.5, 1}) {
    const CameraRays rays({eye, look_at, {0, 1, 0}, 60}, mesh_.space, kWidth, kHeight,
                          PixelSamples(PixelFilter::box, 2, 5), 5);
    return {placement_, rays, {credits, kWidth, kHeight, 2, {0, 2, 1}, true}};
  }

  Mesh mesh_ = make_mesh(room_with_box(), {.patch_length = 0.4, .element_length = 0.2});
  Placement placement_ = make_placement(mesh_, {{3, 2}, std::array<std::uint32_t, 3>{4, 4, 4}, "skewed"});
};

struct Made {
  PeNumber pe;
  RayRecord record;
};

std::vector<Made> rays_in(const std::vector<Sent>& sent) {
  std::vector<Made> made;
  for (const Sent& packet : sent) {
    EXPECT_EQ(packet.record_bytes, sizeof(RayRecord));
    const std::size_t count = packet.bytes.size() / sizeof(RayRecord);
    EXPECT_LE(count, protocol::records_per_packet(protocol::Stage::ray_tracing));
    EXPECT_GE(count, 1U);
    for (std::size_t i = 0; i < count; ++i) made.push_back({packet.pe, packet.as<RayRecord>(i)});
  }
  return made;
}

/// All rays, `home` of them coming home at a time.
std::vector<Made> all_rays(RayTracingPhase& phase, std::uint64_t credits, std::uint32_t home) {
  FakePort port(6);
  phase.start(port);
  std::vector<Made> all;
  std::uint64_t out = 0;
  for (;;) {
    for (const Made& made : rays_in(port.take())) {
      all.push_back(made);
      ++out;
    }
    EXPECT_LE(out, credits);
    EXPECT_EQ(out + phase.credits_home(), credits);
    EXPECT_EQ(phase.done(), out == 0);
    if (out == 0) return all;
    const auto count = static_cast<std::uint32_t>(std::min<std::uint64_t>(home, out));
    out -= count;
    tell(phase, port, 0, MessageKind::credits, protocol::Credits{count});
  }
}

TEST_F(RayTracingPhaseTest, SaysWhatItComputes) {
  FakePort port(6);
  RayTracingPhase tested = phase(1000);
  tested.start(port);
  EXPECT_EQ(port.done(HostWork::camera_ray), std::uint64_t{kWidth} * kHeight * 2);
  EXPECT_GE(port.done(HostWork::subspace), tested.sent()) << "each ray begins in one";
  EXPECT_EQ(port.done(HostWork::entry), 0U);
  tell(tested, port, 0, MessageKind::credits, protocol::Credits{1});
  EXPECT_EQ(port.done(HostWork::entry), 1U);
}

TEST_F(RayTracingPhaseTest, EachSampleOfEachPixelGoesOutOnce) {
  for (const std::uint64_t credits : {1U, 7U, 100U, 1000U}) {
    RayTracingPhase tested = phase(credits);
    const auto made = all_rays(tested, credits, 5);
    EXPECT_EQ(made.size(), kWidth * kHeight * 2);
    EXPECT_EQ(tested.sent(), made.size());
    std::set<std::uint32_t> keys;
    std::vector<int> samples(kWidth * kHeight);
    for (const Made& one : made) {
      keys.insert(one.record.key);
      const auto number = static_cast<std::uint32_t>(samples.at(one.record.pixel)++);
      EXPECT_EQ(one.record.sample, number) << "samples of a pixel go out in their order";
      EXPECT_EQ(one.record.weight, (protocol::Vec3f{0.5F, 0.5F, 0.5F})) << "of two samples";
      EXPECT_EQ(one.record.polygon, protocol::kNoPolygon);
      EXPECT_EQ(one.record.bounce, 0);
      EXPECT_EQ(one.record.waiting, 0);
    }
    EXPECT_EQ(keys.size(), made.size()) << "each with random numbers of its own";
    for (const int count : samples) EXPECT_EQ(count, 2);
  }
}

TEST_F(RayTracingPhaseTest, TheFirstSamplesOfAllPixelsComeFirstAndNeighboursInTimeAreApart) {
  RayTracingPhase tested = phase(1);  // one at a time: the order of sending is the order of making
  const auto made = all_rays(tested, 1, 1);
  std::set<std::uint32_t> seen;
  unsigned apart = 0;
  for (std::size_t i = 0; i < made.size(); ++i) {
    const std::uint32_t pixel = made[i].record.pixel;
    if (i == kWidth * kHeight) seen.clear();
    EXPECT_TRUE(seen.insert(pixel).second) << "ray " << i;
    if (i == 0) continue;
    const auto row = [](const Made& one) { return static_cast<int>(one.record.pixel / kWidth); };
    if (std::abs(row(made[i]) - row(made[i - 1])) >= 2) ++apart;
  }
  EXPECT_GT(apart, made.size() * 9 / 10);
}

TEST_F(RayTracingPhaseTest, EachRayGoesToThePeThatHoldsItsFirstSubspace) {
  RayTracingPhase tested = phase(64);
  std::set<PeNumber> pes;
  for (const Made& one : all_rays(tested, 64, 16)) {
    const auto first = first_subspace(placement_.grid, one.record.origin, one.record.direction, nullptr);
    ASSERT_TRUE(first);
    pes.insert(one.pe);
    // The eye stands in a subspace with walls, so no empty one is stepped over.
    EXPECT_EQ(one.pe, placement_.pe_of_cell[first->cell]);
    const auto cell = placement_.grid.cell(first->cell);
    EXPECT_EQ(one.record.place, protocol::cell_code(cell[0], cell[1], cell[2]));
  }
  EXPECT_EQ(pes.size(), 1U) << "one eye";
  RayTracingPhase outside = phase(64, {0.5, 0.5, -2});
  pes.clear();
  for (const Made& one : all_rays(outside, 64, 16)) pes.insert(one.pe);
  EXPECT_GT(pes.size(), 2U) << "from outside they enter in many places";
}

TEST_F(RayTracingPhaseTest, RaysThatMissTheObjectSpaceTakeNoCredit) {
  RayTracingPhase away = phase(3, {0.5, 0.5, -2}, {0.5, 0.5, -9});
  FakePort port(6);
  away.start(port);
  EXPECT_TRUE(port.take().empty());
  EXPECT_TRUE(away.done());
  EXPECT_EQ(away.sent(), 0U);
  EXPECT_EQ(away.made(), away.count());
}

TEST_F(RayTracingPhaseTest, MessagesThatCannotBeAreRefused) {
  RayTracingPhase tested = phase(10);
  FakePort port(6);
  tested.start(port);
  EXPECT_THROW(tell(tested, port, 0, MessageKind::ready), MachineFailure);
  EXPECT_THROW(tell(tested, port, 0, MessageKind::credits), MachineFailure) << "too short";
  EXPECT_THROW(tell(tested, port, 0, MessageKind::credits, protocol::Credits{11}), MachineFailure) << "10 are out";
}

}  // namespace
}  // namespace torolux::test
