// SPDX-License-Identifier: MIT
// Proves: what is shown of the scene while the radiosity stage runs grows towards the picture that comes of it, and
// looking changes nothing.
#include <gtest/gtest.h>

#include <optional>

#include "host_tools/display/radiosity_view.hpp"
#include "tests/physics/same_picture.hpp"

namespace torolux::test {
namespace {

RenderCase looked_at() {
  RenderCase of = small_cornell();
  of.quality.width = of.quality.height = 64;
  of.quality.samples = 4;
  of.quality.max_shots = 400;  // of what is unshot pictures have an estimate, and looks have none
  of.quality.unshot = 0.01;
  of.machine.progress_seconds = 0;
  return of;
}

struct Looks {
  std::vector<Picture> pictures;
  RenderResult result;
};

Looks look(const RenderCase& of) {
  const Scene scene = load_scene(of.scene, {});
  Looks looks;
  std::optional<RadiosityView> view;
  const auto progress = [&](const RenderProgress& told) {
    if (told.stage != RenderStage::radiosity) return true;
    if (!view) view.emplace(*told.running);
    view->work(*told.running, 10);
    EXPECT_TRUE(view->whole());
    looks.pictures.push_back(view->picture(*told.running));
    return true;
  };
  looks.result = render(scene, *scene.camera, of.quality, of.machine, of.files, pe_image(), progress);
  return looks;
}

/// Mean of a channel.
double mean_of(const Picture& picture, std::size_t channel) {
  double sum = 0;
  for (const auto& pixel : picture.pixels) sum += double{pixel[channel]};
  return sum / static_cast<double>(picture.pixels.size());
}

TEST(RadiosityView, GrowsTowardsThePicture) {
  const Looks looks = look(looked_at());
  ASSERT_GT(looks.pictures.size(), 5U);
  const Picture& last = looks.pictures.back();
  ASSERT_EQ(last.pixels.size(), looks.result.picture.pixels.size());
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t i = 1; i < looks.pictures.size(); ++i)
      EXPECT_GE(mean_of(looks.pictures[i], channel), mean_of(looks.pictures[i - 1], channel));
    EXPECT_LT(mean_of(looks.pictures.front(), channel), 0.9 * mean_of(last, channel));
    // The last look was a little before the stage's end, and each element is flat: a tenth.
    EXPECT_NEAR(mean_of(last, channel), mean_of(looks.result.picture, channel),
                0.1 * mean_of(looks.result.picture, channel));
  }
  // Red to the left, green to the right, as there.
  const auto& left = last.pixels[32 * 64 + 6];
  const auto& right = last.pixels[32 * 64 + 57];
  EXPECT_GT(left[0], 2 * left[1]);
  EXPECT_GT(right[1], 1.5F * right[0]);
}

TEST(RadiosityView, ChangesNothing) {
  const Looks looks = look(looked_at());
  const RenderResult unseen = run_case(looked_at());
  EXPECT_EQ(bytes_of(looks.result.picture), bytes_of(unseen.picture));
  EXPECT_EQ(exact_figures(looks.result.figures), exact_figures(unseen.figures));
}

}  // namespace
}  // namespace torolux::test
