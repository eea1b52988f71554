// SPDX-License-Identifier: MIT
// The path tracer against light that is known exactly, and against itself with other ways to find emitters.
#include "tests/references/path_tracer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "host_tools/scene/load_scene.hpp"
#include "tests/references/light_paths.hpp"
#include "tests/support/memory_files.hpp"

namespace torolux::references {
namespace {

struct Mean {
  double value;
  double error;  ///< one standard deviation, from the differences of the halves
};

/// Of all pixels and channels.
Mean mean_of(const TracedPicture& traced) {
  double sum = 0;
  double square = 0;
  for (std::size_t i = 0; i < traced.picture.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum += static_cast<double>(traced.picture.pixels[i][c]);
      const double half = static_cast<double>(traced.first_half.pixels[i][c] - traced.second_half.pixels[i][c]) / 2;
      square += 3 * half * half;  // channels are not independent of each other
    }
  }
  const double values = 3.0 * static_cast<double>(traced.picture.pixels.size());
  return {sum / values, std::sqrt(square) / values};
}

/// As an OBJ file: an axis-parallel box, fronts outwards or inwards.
std::string box(const char* material, double low, double high, bool outwards) {
  std::string text;
  for (int corner = 0; corner < 8; ++corner) {
    text += "v";
    for (int axis = 0; axis < 3; ++axis) text += " " + std::to_string((corner >> axis & 1) != 0 ? high : low);
    text += "\n";
  }
  text += std::string("usemtl ") + material + "\n";
  for (const char* face : {"-8 -6 -5 -7", "-4 -3 -1 -2", "-8 -7 -3 -4", "-6 -2 -1 -5", "-8 -4 -2 -6", "-7 -5 -1 -3"}) {
    int corner[4];
    std::sscanf(face, "%d %d %d %d", &corner[0], &corner[1], &corner[2], &corner[3]);
    text += "f";
    for (int i = 0; i < 4; ++i) text += " " + std::to_string(corner[outwards ? i : 3 - i]);
    text += "\n";
  }
  return text;
}

Scene scene_of(const std::string& obj, const std::string& mtl) {
  MemoryFiles files({{"s.obj", "mtllib s.mtl\n" + obj}, {"s.mtl", mtl}});
  return load_scene_from(files, "s.obj", {});
}

constexpr const char* kFurnace =
    "newmtl wall\nKd .5 .5 .5\nKe 1 1 1\nnewmtl glass\nillum 7\nNi 1.5\nTf 1 1 1\nnewmtl mirror\nillum 3\nKs .9 .9 "
    ".9\n";

TraceChoice small(std::uint32_t samples) {
  return {24, 24, samples, 7, 1, LightFinding::both};
}

/// A closed box whose walls emit 1 and reflect one half shows 2 everywhere, also through glass that absorbs nothing,
/// and in a mirror that reflects all.
TEST(PathTracer, FurnaceShowsTwoThroughGlassAndInMirrors) {
  const Scene scene =
      scene_of(box("wall", 0, 1, false) + box("glass", .2, .45, true) + box("mirror", .55, .8, true), kFurnace);
  auto materials = materials_of(scene);
  for (Material& material : materials) {
    if (material.model == Model::mirror) material.specular = Colour::Ones();
  }
  const World world(scene, materials, false);
  const TracedPicture traced = trace(world, {{.1, .5, .95}, {.5, .5, .3}, {0, 1, 0}, 80}, small(256));
  const Mean mean = mean_of(traced);
  EXPECT_LT(mean.error, 0.003);
  EXPECT_NEAR(mean.value, 2, 4 * mean.error);
  for (const auto& pixel : traced.picture.pixels) EXPECT_NEAR(pixel[0], 2, 0.5);  // noise of a pixel: 0.06
}

/// Inside glass, radiance is n^2 times as high.
TEST(PathTracer, FurnaceSeenFromInsideGlassIsBrighter) {
  const Scene scene = scene_of(box("wall", 0, 1, false) + box("glass", .3, .7, true), kFurnace);
  const World world(scene, false);
  const Mean mean = mean_of(trace(world, {{.5, .5, .5}, {.5, .5, 0}, {0, 1, 0}, 60}, small(256)));
  EXPECT_NEAR(mean.value, 2 * 1.5 * 1.5, 4 * mean.error);
}

/// A plate of glass before a lamp, square to the view: (1 - R)^2 t^2 / (1 - R^2) of it comes through, R = 0.04.
TEST(PathTracer, PlateOfGlassLetsThroughWhatTheoryAllows) {
  const std::string lamp = "v -9 -9 -3\nv 9 -9 -3\nv 9 9 -3\nv -9 9 -3\nusemtl lamp\nf 1 2 3 4\n";
  const Scene scene = scene_of(lamp + box("glass", -1, 1, true),
                               "newmtl lamp\nKd 0 0 0\nKe 1 1 1\nnewmtl glass\nillum 7\nNi 1.5\nTf .9 .9 .9\n");
  const World world(scene, false);
  // So narrow a view that all rays are square to the plate: cosine above 0.9999.
  const Mean mean = mean_of(trace(world, {{0, 0, 40}, {0, 0, 0}, {0, 1, 0}, 1}, small(256)));
  const double through = 0.96 * 0.96 * 0.81 / (1 - 0.04 * 0.04);
  EXPECT_LT(mean.error, 0.005);
  EXPECT_NEAR(mean.value, through, 4 * mean.error + 1e-4);
}

/// The same as a plate of one sheet, square to the view, and lit from beyond: the floor behind two panes gets as much
/// by asking emitters as by chance.
TEST(PathTracer, PaneLetsThroughWhatBothFacesDo) {
  const std::string lamp = "v -9 -9 -3\nv 9 -9 -3\nv 9 9 -3\nv -9 9 -3\nusemtl lamp\nf 1 2 3 4\n";
  const std::string sheet = "v -5 -5 1\nv 5 -5 1\nv 5 5 1\nv -5 5 1\nusemtl glass\nf 5 6 7 8\n";
  const std::string paper = "v -5 -5 2\nv 5 -5 2\nv 5 5 2\nv -5 5 2\nusemtl paper\nf 12 11 10 9\n";
  Scene scene =
      scene_of(lamp + sheet + paper,
               "newmtl lamp\nKd 0 0 0\nKe 1 1 1\nnewmtl paper\nKd 0 0 0\nnewmtl glass\nillum 7\nNi 1.5\nTf .9 .9 .9\n");
  for (SceneMaterial& material : scene.materials) material.thin = material.kind == SurfaceKind::glass;
  const World world(scene, false);
  const Mean mean = mean_of(trace(world, {{0, 0, 1.9}, {0, 0, 0}, {0, 1, 0}, 1}, small(256)));
  EXPECT_NEAR(mean.value, 0.96 * 0.96 * 0.9 / (1 - 0.81 * 0.04 * 0.04), 4 * mean.error + 1e-4);
  double light[2];
  for (const LightFinding finding : {LightFinding::emitters_only, LightFinding::directions_only}) {
    Samples samples(1, 1);
    double sum = 0;
    constexpr std::uint32_t kSamples = 1U << 14U;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      samples.begin(i);
      sum += incident_over_pi(world, world.at(4, 0.3, 0.3, true), finding, samples)[1] / kSamples;
    }
    light[finding == LightFinding::emitters_only ? 0 : 1] = sum;
  }
  EXPECT_NEAR(light[0], light[1], 0.02 * light[1]);
}

/// Under the centre of a unit square at distance 1: form factor 0.239456470461 (../shared/data/references.md).
TEST(PathTracer, LightUnderASquareLampIsExact) {
  const Scene scene = scene_of(
      "v 0 0 1\nv 0 1 1\nv 1 1 1\nv 1 0 1\nusemtl lamp\nf 1 2 3 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl paper\n"
      "f 5 6 7 8\n",
      "newmtl lamp\nKd 0 0 0\nKe 3 3 3\nnewmtl paper\nKd .5 .5 .5\n");
  const World world(scene, false);
  ASSERT_EQ(world.triangles().size(), 4U);
  for (const LightFinding finding : {LightFinding::both, LightFinding::emitters_only, LightFinding::directions_only}) {
    Samples samples(1, 1);
    double sum = 0;
    constexpr std::uint32_t kSamples = 1U << 15U;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      samples.begin(i);
      sum += incident_over_pi(world, world.at(2, 0, 0.5, true), finding, samples)[1] / kSamples;
    }
    // 32768 well spread samples, 3 * 0.43 the spread of one: independent ones would be within 0.007.
    EXPECT_NEAR(sum / 3, 0.239456470461, 0.0008) << static_cast<int>(finding);
  }
}

/// Under a sky of radiance 3: as much comes through a unit square at distance 1 as a lamp there would give, and with
/// the directions that surfaces scatter to, as much as from all around.
TEST(PathTracer, OpeningsAreAskedForTheirPartOfTheSky) {
  Scene scene =
      scene_of("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl paper\nf 1 2 3 4\n", "newmtl paper\nKd .5 .5 .5\n");
  Sky sky;
  sky.radiance.assign(32 * 64, {3, 3, 3});
  // The second one faces away: nothing comes from its back.
  sky.openings = {{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}, {{4, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
  scene.sky = sky;
  const World world(scene, false);
  const Hit corner = world.at(0, 0, 0, true);
  const auto light = [&](LightFinding finding) {
    Samples samples(1, 1);
    double sum = 0;
    constexpr std::uint32_t kSamples = 1U << 15U;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      samples.begin(i);
      sum += incident_over_pi(world, corner, finding, samples)[1] / kSamples;
    }
    return sum / 3;
  };
  // Over a corner of the square below it: form factor of a point to a square, by its closed form.
  const double root = std::sqrt(2.0);
  EXPECT_NEAR(light(LightFinding::emitters_only), 2 / root * std::atan(1 / root) / (2 * std::numbers::pi), 0.001);
  EXPECT_NEAR(light(LightFinding::both), 1, 0.003);
  EXPECT_NEAR(light(LightFinding::directions_only), 1, 1e-9);
}

/// Emitters met by chance and asked for directly: the same light. All white surfaces emit, so that chance finds them.
TEST(PathTracer, EitherWayToFindEmittersGivesTheSameLight) {
  const Scene scene = load_scene(std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes" / "cornell_box", {});
  auto materials = materials_of(scene);
  for (Material& material : materials) {
    if (material.diffuse[1] > 0.7) material.emission = {1, 2, 3};
    if (material.diffuse[1] < 0.1) {
      material.model = Model::glossy;
      material.specular = Colour::Constant(0.3);
      material.exponent = 30;
    }
  }
  const World world(scene, materials, false);
  const auto mean = [&](LightFinding finding) {
    TraceChoice choice = small(512);
    choice.seed += static_cast<std::uint64_t>(finding);
    choice.finding = finding;
    return mean_of(trace(world, *scene.camera, choice));
  };
  const Mean both = mean(LightFinding::both);
  for (const LightFinding finding : {LightFinding::emitters_only, LightFinding::directions_only}) {
    const Mean one = mean(finding);
    EXPECT_LT(one.error, 0.01 * one.value);
    EXPECT_NEAR(one.value, both.value, 4 * std::hypot(one.error, both.error));
  }
}

TEST(PathTracer, ThreadsDoNotShow) {
  const Scene scene = load_scene(std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes" / "cornell_spheres", {});
  const World world(scene, false);
  TraceChoice choice = small(4);
  choice.caustics = Caustics::from_light;
  const Picture one = trace(world, *scene.camera, choice).picture;
  choice.threads = 3;
  const Picture three = trace(world, *scene.camera, choice).picture;
  EXPECT_EQ(std::memcmp(one.pixels.data(), three.pixels.data(), one.pixels.size() * sizeof(one.pixels[0])), 0);
}

/// A mirror and a glass ball, round ones with interpolated normals. Most surfaces emit, so that chance finds them, too;
/// one wall is glossy.
World wide_lights_and_spheres(const Scene& scene) {
  auto materials = materials_of(scene);
  for (Material& material : materials) {
    if (material.diffuse[1] > 0.7) material.emission = {1, 2, 3};
    if (material.diffuse[1] < 0.1 && material.model == Model::diffuse) {
      material.model = Model::glossy;
      material.specular = Colour::Constant(0.3);
      material.exponent = 30;
    }
  }
  return {scene, materials, false};
}

/// What comes by way of mirrors and glass, from the eye and from the light: as bright.
TEST(PathTracer, CausticsFromTheLightAreAsBrightAsFromTheEye) {
  const Scene scene = load_scene(std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes" / "cornell_spheres", {});
  const World world = wide_lights_and_spheres(scene);
  TraceChoice choice = small(1024);
  const TracedPicture all = trace(world, *scene.camera, choice);
  choice.caustics = Caustics::from_light;
  TracedPicture caustics = trace(world, *scene.camera, choice);  // of the same paths from the eye
  const TracedPicture from_light = trace_caustics(world, *scene.camera, choice);
  const auto found_by_eye = [](const Picture& eye, const Picture& light, Picture& sum) {
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) sum.pixels[i][c] = eye.pixels[i][c] - (sum.pixels[i][c] - light.pixels[i][c]);
    }
  };
  found_by_eye(all.picture, from_light.picture, caustics.picture);
  found_by_eye(all.first_half, from_light.first_half, caustics.first_half);
  found_by_eye(all.second_half, from_light.second_half, caustics.second_half);
  const Mean eye = mean_of(caustics);
  const Mean light = mean_of(from_light);
  const double error = std::hypot(eye.error, light.error);
  EXPECT_LT(error, 0.01 * light.value);
  EXPECT_NEAR(eye.value, light.value, 3 * error);
}

/// By how much pictures of the same paths from the eye differ where caustics are found otherwise, over their mean.
Mean difference_of_ways(const World& world, const Camera& camera) {
  TraceChoice choice = small(1024);
  const TracedPicture by_luck = trace(world, camera, choice);
  choice.caustics = Caustics::from_light;
  TracedPicture difference = trace(world, camera, choice);
  for (std::size_t i = 0; i < by_luck.picture.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      difference.picture.pixels[i][c] -= by_luck.picture.pixels[i][c];
      difference.first_half.pixels[i][c] -= by_luck.first_half.pixels[i][c];
      difference.second_half.pixels[i][c] -= by_luck.second_half.pixels[i][c];
    }
  }
  const Mean all = mean_of(by_luck);
  const Mean more = mean_of(difference);
  return {more.value / all.value, more.error / all.value};
}

/// With all ways together, caustics seen in mirrors, in glass and on what is glossy included.
TEST(PathTracer, NoWayToFindCausticsAddsLight) {
  const Scene scene = load_scene(std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes" / "cornell_spheres", {});
  const Mean difference = difference_of_ways(wide_lights_and_spheres(scene), *scene.camera);
  EXPECT_LT(difference.error, 0.001);
  EXPECT_NEAR(difference.value, 0, 3 * difference.error);
}

/// What is seen through a pane is seen from the light; the path from the eye must not find it as well.
TEST(PathTracer, CausticsBehindAPaneCountOnce) {
  Scene scene = load_scene(std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes" / "cornell_spheres", {});
  SceneMaterial pane;
  pane.kind = SurfaceKind::glass;
  pane.thin = true;
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const Vec3d& corner : {Vec3d{-1e3, -1e3, -700}, {2e3, -1e3, -700}, {278, 4e3, -700}})
    scene.positions.push_back(corner);
  scene.triangles.push_back({{first, first + 1, first + 2},
                             {kNoNormal, kNoNormal, kNoNormal},
                             static_cast<std::uint32_t>(scene.materials.size())});
  scene.materials.push_back(pane);
  const Mean difference = difference_of_ways(wide_lights_and_spheres(scene), *scene.camera);
  EXPECT_LT(difference.error, 0.001);
  EXPECT_NEAR(difference.value, 0, 3 * difference.error);
}

/// Of the glass ball's foot the part that mirrors the caustic beside it, and nothing else.
TEST(PathTracer, CausticsSeenInGlassNeedNoLuck) {
  const Scene scene = load_scene(std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes" / "caustic", {});
  const World world(scene, false);
  const Camera camera{scene.camera->eye, {0.151, 0, 0.121}, {0, 1, 0}, 0.6};
  TraceChoice choice = small(256);
  const Mean by_luck = mean_of(trace(world, camera, choice));
  choice.caustics = Caustics::from_light;
  const Mean tried = mean_of(trace(world, camera, choice));
  EXPECT_LT(tried.error, by_luck.error / 2);  // measured 3.8 at 512 paths per pixel; a sixth were there no other noise
}

}  // namespace
}  // namespace torolux::references
