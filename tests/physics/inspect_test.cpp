// SPDX-License-Identifier: MIT
// Proves of answers about a run: the scene as its elements have it is the machine's picture but for interpolation; an
// element's light is found again by looking back from it; a PE's stores fill its memory as told; and asking changes
// nothing of the run.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/inspect/answer_json.hpp"
#include "host_tools/inspect/answer_text.hpp"
#include "host_tools/inspect/inspector.hpp"
#include "host_tools/inspect/packet_log.hpp"
#include "host_tools/render/session.hpp"
#include "tests/physics/same_picture.hpp"

namespace torolux::test {
namespace {

const std::function<bool(const RenderProgress&)> kNobody;

/// A solved scene whose PE 5 is watched.
struct Asked {
  RenderCase of;
  Scene scene;
  Camera camera;
  PacketLog log{5, nullptr};
  RenderSession session;
  RenderResult result;
  Inspector inspector;

  explicit Asked(const RenderCase& render_case)
      : of(render_case),
        scene(load_scene(of.scene, {})),
        camera(scene.camera.value()),
        session(scene, camera, of.quality, watched(), of.files, pe_image(), kNobody),
        result(session.run(Machine::Then::end)),
        inspector(
            {scene, camera, of.quality, of.machine, session.setup(), session.solution(), result.figures.machine}) {}

  const MachineChoice& watched() {
    of.machine.follower = &log;
    return of.machine;
  }
};

RenderCase cornell(const std::string& name) {
  RenderCase of = small_cornell(name.c_str());
  of.machine.columns = of.machine.rows = 4;
  take_scheme(of.machine, Scheme::paper);
  return of;
}

double sum_of(const Vec3d& v) {
  return v[0] + v[1] + v[2];
}

double mean_of(const Picture& picture) {
  double sum = 0;
  for (const auto& pixel : picture.pixels) sum += double{pixel[0]} + double{pixel[1]} + double{pixel[2]};
  return sum / static_cast<double>(picture.pixels.size());
}

// Interpolation between elements moves light, but makes none: the means are close. Mirrored too: the picture of the
// spheres has a mirror.
TEST(Inspect, ElementsShowTheMachinesPicture) {
  RenderCase of = cornell("cornell_box");
  of.quality.samples = 1;
  const Asked asked(of);
  const Picture seen = asked.inspector.picture();
  ASSERT_EQ(seen.pixels.size(), asked.result.picture.pixels.size());
  const double mean = mean_of(asked.result.picture);
  EXPECT_NEAR(mean_of(seen), mean, 0.03 * mean);
  double apart = 0;
  for (std::size_t i = 0; i < seen.pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      apart += std::abs(double{seen.pixels[i][c]} - double{asked.result.picture.pixels[i][c]});
  EXPECT_LT(apart / static_cast<double>(seen.pixels.size()), 0.15 * mean) << "elements of a small case are large";
}

TEST(Inspect, AnElementsLightIsFoundAgain) {
  const Asked asked(cornell("cornell_box"));
  const std::uint32_t middle = asked.inspector.view().width() / 2;
  std::size_t asked_of = 0;
  double found = 0, held = 0;
  for (std::uint32_t row = 1; row < asked.inspector.view().height(); row += 3) {
    const auto number = asked.inspector.element_at(middle, row);
    if (!number) continue;
    const ElementAnswer answer = asked.inspector.element(*number);
    EXPECT_EQ(answer.element, *number);
    EXPECT_GT(answer.pixels, 0U);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(answer.irradiance[c] * answer.area, answer.incident[c], 1e-9 * answer.incident[c]);
      EXPECT_LE(answer.direct.value()[c], answer.incident[c]);
    }
    held += sum_of(answer.incident);
    for (const LightSource& source : answer.sources) found += source.sum();
    for (std::size_t i = 1; i < answer.sources.size(); ++i)
      EXPECT_GE(answer.sources[i - 1].sum(), answer.sources[i].sum());
    EXPECT_EQ(answer_json(answer)["owner"], answer.owner);
    EXPECT_NE(answer_text(answer).find("PE " + std::to_string(answer.owner)), std::string::npos);
    ++asked_of;
  }
  EXPECT_GT(asked_of, 5U);
  EXPECT_NEAR(found, held, 0.15 * held) << "hemi-cubes of a small case are coarse";
}

TEST(Inspect, OfAllElementsOfAPatchIsThePatchs) {
  const Asked asked(cornell("cornell_box"));
  const Solution& solution = asked.session.solution();
  const MeshPatch& patch = asked.session.setup().mesh.patches.at(3);
  double sum = 0, area = 0;
  for (std::uint32_t i = 0; i < patch.elements; ++i) {
    const ElementAnswer answer = asked.inspector.element(patch.first_element[0] + i);
    EXPECT_EQ(answer.patch, 3U);
    EXPECT_EQ(answer.of_patch, i);
    sum += answer.incident[0];
    area += answer.area;
  }
  const double whole =
      static_cast<double>(solution.sides[patch.side[0]].incident[0]) * asked.session.setup().units.watts_per_quantum;
  EXPECT_NEAR(sum, whole, 1e-9 * whole);
  EXPECT_NEAR(area, patch.area, 1e-6 * patch.area);
  EXPECT_THROW(asked.inspector.element(asked.session.setup().mesh.elements), InputError);
}

TEST(Inspect, APesMemoryAndPackets) {
  const Asked asked(cornell("cornell_box"));
  std::uint64_t pixels = 0, seen = 0;
  for (unsigned pe = 0; pe < 16; ++pe) {
    const PeAnswer answer = asked.inspector.pe(pe, {});
    pixels += answer.pixels;
    std::uint64_t packets = 0;
    for (const PeStage& stage : answer.stages) {
      std::uint64_t stores = stage.image_bytes;
      for (const StoreBytes& store : stage.stores) stores += store.bytes;
      EXPECT_LE(stores, stage.used_bytes);
      EXPECT_LT(stage.used_bytes - stores, 8 * 32U) << "stores are aligned to 8 bytes";
      EXPECT_LE(stage.used_bytes, stage.available_bytes);
      ASSERT_TRUE(stage.figures);
      packets += stage.figures->packets_sent;
    }
    EXPECT_EQ(packets, answer.figures.packets_sent) << "of records, which only these stages send";
  }
  for (const Sight& sight : asked.inspector.view().sights()) seen += sight.first_cell ? 1 : 0;
  EXPECT_EQ(pixels, seen) << "without copies each subspace has one PE";
  const PeAnswer fifth = asked.inspector.pe(5, asked.log.packets());
  EXPECT_EQ(fifth.last_packets.size(), PacketLog::kKept);
  for (std::size_t i = 1; i < fifth.last_packets.size(); ++i)
    EXPECT_LE(fifth.last_packets[i - 1].time, fifth.last_packets[i].time);
  EXPECT_EQ(answer_json(fifth)["last_packets"].size(), PacketLog::kKept);
  EXPECT_THROW(asked.inspector.pe(16, {}), InputError);
}

TEST(Inspect, ChangesNothing) {
  const RenderCase of = cornell("cornell_spheres");
  const Asked asked(of);
  const RenderResult alone = run_case(of);
  EXPECT_EQ(bytes_of(asked.result.picture), bytes_of(alone.picture));
  EXPECT_EQ(exact_figures(asked.result.figures), exact_figures(alone.figures));
}

}  // namespace
}  // namespace torolux::test
