// SPDX-License-Identifier: MIT
// Proves of a machine that stays after its picture: views are the pictures that a render with their camera gives, in
// one pass or several, large or small, also after views that were given up; and staying changes nothing of the render.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "host_tools/render/session.hpp"
#include "tests/physics/same_picture.hpp"

namespace torolux::test {
namespace {

const std::function<bool(const RenderProgress&)> kNobody;
const std::function<bool()> kWanted = [] { return true; };

Camera other_camera(const Camera& camera) {
  Camera other = camera;
  other.eye[0] += 60;
  other.look_at[1] -= 30;
  return other;
}

struct Stayed {
  RenderCase of;
  Scene scene;
  Camera camera;
  RenderSession session;
  RenderResult first;

  explicit Stayed(const RenderCase& render_case)
      : of(render_case),
        scene(load_scene(of.scene, {})),
        camera(scene.camera.value()),
        session(scene, camera, of.quality, of.machine, of.files, pe_image(), kNobody),
        first(session.run(Machine::Then::stay)) {}

  Picture rendered_from(const Camera& eye) const {
    RenderCase again = of;
    again.camera = eye;
    return run_case(again).picture;
  }
};

RenderCase spheres() {
  RenderCase of = small_cornell("cornell_spheres");
  of.quality.samples = 5;
  return of;
}

TEST(Session, StayingChangesNothing) {
  const Stayed stayed(spheres());
  const RenderResult ended = run_case(stayed.of);
  EXPECT_EQ(bytes_of(stayed.first.picture), bytes_of(ended.picture));
  EXPECT_EQ(exact_figures(stayed.first.figures), exact_figures(ended.figures));
}

// Whoever makes the rays: PEs of tiles, or the host.
TEST(Session, ViewsAreWhatARenderGives) {
  for (const bool host : {false, true}) {
    RenderCase of = spheres();
    if (host) of.machine.camera_rays = RayMaker::host;
    Stayed stayed(of);
    const Camera other = other_camera(stayed.camera);
    const auto [width, height, samples] = std::tuple{of.quality.width, of.quality.height, of.quality.samples};
    const auto wanted = bytes_of(stayed.rendered_from(other));
    ASSERT_NE(wanted, bytes_of(stayed.first.picture)) << "another camera sees something else";

    EXPECT_TRUE(stayed.session.view({other, width, height, {0, samples, 1}}, kWanted));
    EXPECT_EQ(bytes_of(stayed.session.picture(samples)), wanted) << host;
    // A coarse one in between; then in passes, in another order of samples.
    EXPECT_TRUE(stayed.session.view({stayed.camera, width / 4, height / 4, {0, 1, 1}}, kWanted));
    EXPECT_EQ(stayed.session.frame_buffer().width, width / 4);
    EXPECT_TRUE(stayed.session.view({other, width, height, {0, 2, 3}}, kWanted));
    EXPECT_TRUE(stayed.session.view({other, width, height, {2, samples - 2, 3}, true}, kWanted));
    EXPECT_EQ(bytes_of(stayed.session.picture(samples)), wanted) << host;
  }
}

// A part of the samples is a picture of the same brightness.
TEST(Session, FewSamplesWeighAsMuchAsAll) {
  Stayed stayed(spheres());
  const auto mean = [](const Picture& picture) {
    double sum = 0;
    for (const auto& pixel : picture.pixels) sum += static_cast<double>(pixel[1]);
    return sum / static_cast<double>(picture.pixels.size());
  };
  const double whole = mean(stayed.first.picture);
  const auto [width, height] = std::pair{stayed.of.quality.width, stayed.of.quality.height};
  stayed.session.view({stayed.camera, width, height, {0, 1, 3}}, kWanted);
  // Weighed wrongly it would be off by a factor of 5; by noise (few of a thousand pixels show the lamp) by a fifth.
  EXPECT_NEAR(mean(stayed.session.picture(1)) / whole, 1, 0.4);
}

TEST(Session, AViewThatIsGivenUpLeavesNothingBehind) {
  Stayed stayed(spheres());
  const auto [width, height, samples] =
      std::tuple{stayed.of.quality.width, stayed.of.quality.height, stayed.of.quality.samples};
  const View whole{other_camera(stayed.camera), width, height, {0, samples, 1}};
  EXPECT_FALSE(stayed.session.view(whole, [] { return false; })) << "before it has begun";
  int asked = 0;
  View large = whole;
  large.width = large.height = 400;
  EXPECT_FALSE(stayed.session.view(large, [&asked] { return ++asked < 2; })) << "while it runs";
  // Progress is asked for by the clock on the wall, so how often is not known; but most pixels were never dealt.
  const auto given_up = stayed.session.picture(samples).pixels;
  EXPECT_GT(std::ranges::count(given_up, std::array<float, 3>{}), std::ssize(given_up) / 2) << "and it ends soon after";
  EXPECT_TRUE(stayed.session.view(whole, kWanted));
  EXPECT_EQ(bytes_of(stayed.session.picture(samples)), bytes_of(stayed.rendered_from(whole.camera)));
}

}  // namespace
}  // namespace torolux::test
