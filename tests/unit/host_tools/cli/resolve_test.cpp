// SPDX-License-Identifier: MIT
// Proves: an option given outweighs the scene's default, which outweighs the built-in one, for each of them.
#include "host_tools/cli/resolve.hpp"

#include <gmock/gmock.h>

#include "emulator/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux {
namespace {

using testing::HasSubstr;
using testing_support::message_of;

Scene scene_with_defaults() {
  Scene scene;
  scene.name = "room";
  scene.camera = Camera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 55};
  GivenSettings& d = scene.defaults.given;
  d.set(&Quality::width, 101);
  d.set(&Quality::height, 102);
  d.set(&Quality::samples, 103);
  d.set(&Quality::hemicube, 104);
  d.set(&Quality::shot_points, 5);
  d.set(&Quality::emission_records, 108);
  d.set(&Quality::max_shots, 106);
  d.set(&Quality::bounces, 107);
  d.set(&ToneMapping::exposure_ev, 1.5);
  d.set(&Quality::patch_length, 2.5);
  d.set(&Quality::element_length, 3.5);
  d.set(&Quality::unshot, 0.25);
  scene.defaults.subspaces = PlacedText{"2x3x4", ""};
  scene.defaults.allocation = PlacedText{"block", ""};
  d.set(&Quality::seed, 99);
  d.set(&Quality::two_sided_lights, true);
  d.set(&Quality::shadow_rays, true);
  d.set(&Quality::filter, PixelFilter::box);
  return scene;
}

Scene bare_scene() {
  Scene scene;
  scene.name = "bare";
  scene.camera = Camera{};
  return scene;
}

TEST(Resolve, BuiltInValues) {
  const Resolved resolved = resolve({}, bare_scene());
  const Quality built_in;
  EXPECT_EQ(resolved.quality.width, built_in.width);
  EXPECT_EQ(resolved.quality.hemicube, built_in.hemicube);
  EXPECT_EQ(resolved.quality.unshot, built_in.unshot);
  EXPECT_EQ(resolved.quality.patch_length, std::nullopt);
  EXPECT_FALSE(resolved.quality.two_sided_lights);
  EXPECT_TRUE(resolved.quality.shadow_rays);
  EXPECT_EQ(resolved.quality.filter, built_in.filter);
  EXPECT_EQ(resolved.machine.columns, 4U);
  EXPECT_EQ(resolved.machine.subspaces, std::nullopt);
  EXPECT_EQ(resolved.machine.scheme, Scheme::spread);
  EXPECT_EQ(resolved.machine.allocation, "balanced");
  EXPECT_EQ(resolved.tone.exposure_ev, 0);
  EXPECT_EQ(resolved.tone.curve, ToneCurve::filmic);
  EXPECT_THAT(resolved.outputs, testing::ElementsAre("bare.png"));
}

TEST(Resolve, AllocationFollowsTheScheme) {
  RenderOptions options;
  EXPECT_EQ(resolve(options, bare_scene()).machine.allocation, allocation_of(MachineChoice().scheme));
  options.given.set(&MachineChoice::scheme, Scheme::spread);
  EXPECT_EQ(resolve(options, bare_scene()).machine.allocation, "balanced");
  options.given.set(&MachineChoice::scheme, Scheme::paper);
  EXPECT_EQ(resolve(options, bare_scene()).machine.allocation, "skewed");
  EXPECT_EQ(resolve(options, scene_with_defaults()).machine.allocation, "block") << "the scene's";
  options.given.set(&MachineChoice::allocation, "modulo");
  options.given.set(&MachineChoice::replicate, 0.25);
  EXPECT_EQ(resolve(options, bare_scene()).machine.allocation, "modulo");
  EXPECT_EQ(resolve(options, bare_scene()).machine.replicate, 0.25);
}

TEST(Resolve, EachStepFollowsTheSchemeUnlessGiven) {
  RenderOptions options;
  const auto machine = [&options] { return resolve(options, bare_scene()).machine; };
  EXPECT_EQ(machine().points, Points::travel);
  EXPECT_EQ(machine().empty, Empty::over);
  EXPECT_EQ(machine().camera_rays, RayMaker::pes);
  EXPECT_EQ(machine().replicate, std::nullopt);
  options.given.set(&MachineChoice::scheme, Scheme::paper);
  EXPECT_EQ(machine().points, Points::stay);
  EXPECT_EQ(machine().empty, Empty::enter);
  EXPECT_EQ(machine().camera_rays, RayMaker::host);
  EXPECT_EQ(machine().replicate, 0.0);
  options.given.set(&MachineChoice::points, Points::travel);
  EXPECT_EQ(machine().points, Points::travel);
  EXPECT_EQ(machine().empty, Empty::enter) << "one at a time";
  options.given.set(&MachineChoice::empty, Empty::over);
  options.given.set(&MachineChoice::camera_rays, RayMaker::pes);
  options.given.set(&MachineChoice::replicate, std::nullopt);
  EXPECT_EQ(machine().empty, Empty::over);
  EXPECT_EQ(machine().camera_rays, RayMaker::pes);
  EXPECT_EQ(machine().replicate, std::nullopt) << "auto outweighs the scheme's 0";
}

TEST(Resolve, SceneOutweighsBuiltIn) {
  const Resolved resolved = resolve({}, scene_with_defaults());
  const Quality& q = resolved.quality;
  EXPECT_EQ(q.width, 101U);
  EXPECT_EQ(q.height, 102U);
  EXPECT_EQ(q.samples, 103U);
  EXPECT_EQ(q.hemicube, 104U);
  EXPECT_EQ(q.shot_points, 5U);
  EXPECT_EQ(q.emission_records, 108U);
  EXPECT_EQ(q.max_shots, 106U);
  EXPECT_EQ(q.bounces, 107U);
  EXPECT_EQ(q.patch_length, 2.5);
  EXPECT_EQ(q.element_length, 3.5);
  EXPECT_EQ(q.unshot, 0.25);
  EXPECT_EQ(q.seed, 99U);
  EXPECT_TRUE(q.two_sided_lights);
  EXPECT_TRUE(q.shadow_rays);
  EXPECT_EQ(q.filter, PixelFilter::box);
  EXPECT_EQ(resolved.tone.exposure_ev, 1.5);
  EXPECT_EQ(resolved.machine.subspaces, (std::array<std::uint32_t, 3>{2, 3, 4}));
  EXPECT_EQ(resolved.machine.allocation, "block");
  EXPECT_EQ(resolved.camera.field_of_view_degrees, 55);
}

RenderOptions all_given() {
  RenderOptions options;
  options.given.set(&Quality::width, 11);
  options.given.set(&Quality::height, 12);
  options.given.set(&Quality::samples, 13);
  options.given.set(&Quality::hemicube, 14);
  options.given.set(&Quality::shot_points, 15);
  options.given.set(&Quality::emission_records, 21);
  options.given.set(&Quality::max_shots, 16);
  options.given.set(&Quality::bounces, 17);
  options.given.set(&Quality::patch_length, std::nullopt);  // auto, given
  options.given.set(&Quality::element_length, 18);
  options.given.set(&Quality::unshot, 0.19);
  options.given.set(&Quality::seed, 20);
  options.given.set(&Quality::shadow_rays, false);
  options.given.set(&Quality::filter, PixelFilter::gaussian);
  options.given.set(&Quality::layers, 6);
  options.given.set(&ToneMapping::exposure_ev, -2);
  options.given.set(&ToneMapping::curve, ToneCurve::linear);
  options.given.set(&MachineChoice::subspaces, std::nullopt);  // auto, given
  options.given.set(&MachineChoice::allocation, "modulo");
  options.given.set(&MachineChoice::columns, 3);
  options.given.set(&MachineChoice::rows, 5);
  options.given.set(&MachineChoice::pe_memory, 1U << 20U);
  options.given.set(&MachineChoice::threads, 2);
  options.eye = {{1, 2, 3}};
  options.field_of_view_degrees = 33;
  options.outputs = {"a.exr", "b.pfm"};
  return options;
}

TEST(Resolve, OptionsOutweighTheScene) {
  const Resolved resolved = resolve(all_given(), scene_with_defaults());
  const Quality& q = resolved.quality;
  EXPECT_EQ(q.width, 11U);
  EXPECT_EQ(q.height, 12U);
  EXPECT_EQ(q.samples, 13U);
  EXPECT_EQ(q.hemicube, 14U);
  EXPECT_EQ(q.shot_points, 15U);
  EXPECT_EQ(q.emission_records, 21U);
  EXPECT_EQ(q.max_shots, 16U);
  EXPECT_EQ(q.bounces, 17U);
  EXPECT_EQ(q.patch_length, std::nullopt);
  EXPECT_EQ(q.element_length, 18);
  EXPECT_EQ(q.unshot, 0.19);
  EXPECT_EQ(q.seed, 20U);
  EXPECT_EQ(q.filter, PixelFilter::gaussian);
  EXPECT_EQ(q.layers, 6U);
  EXPECT_FALSE(q.shadow_rays) << "--direct radiosity, given";
  EXPECT_EQ(resolved.tone.exposure_ev, -2);
  EXPECT_EQ(resolved.tone.curve, ToneCurve::linear);
  EXPECT_EQ(resolved.machine.subspaces, std::nullopt);
  EXPECT_EQ(resolved.machine.allocation, "modulo");
  EXPECT_EQ(resolved.machine.columns, 3U);
  EXPECT_EQ(resolved.machine.rows, 5U);
  EXPECT_EQ(resolved.machine.pe_memory, 1U << 20U);
  EXPECT_EQ(resolved.machine.threads, 2U);
  EXPECT_EQ(resolved.camera.eye, (Vec3d{1, 2, 3}));
  EXPECT_EQ(resolved.camera.look_at, (Vec3d{0, 0, 0})) << "not given: the scene's";
  EXPECT_EQ(resolved.camera.field_of_view_degrees, 33);
  EXPECT_THAT(resolved.outputs, testing::ElementsAre("a.exr", "b.pfm"));
}

Quality quality_of(const Scene& scene, const char* preset) {
  RenderOptions options;
  options.preset = preset_named(preset);
  return resolve(options, scene).quality;
}

TEST(Resolve, APresetIsAllThatABareSceneGets) {
  for (const Preset& preset : kPresets) {
    Quality should;
    apply(with_final_gathering(preset), should);
    const Quality is = quality_of(bare_scene(), preset.name.data());
    EXPECT_EQ(is.samples, should.samples);
    EXPECT_EQ(is.hemicube, should.hemicube);
    EXPECT_EQ(is.shot_points, should.shot_points);
    EXPECT_EQ(is.emission_records, should.emission_records);
    EXPECT_EQ(is.final_gather, should.final_gather);
    EXPECT_EQ(is.unshot, should.unshot);
    EXPECT_EQ(is.refine, should.refine);
    EXPECT_TRUE(is.shadow_rays);
    EXPECT_EQ(is.patch_factor, should.patch_factor);
    EXPECT_EQ(is.element_factor, should.element_factor);
  }
}

// A scene says what it needs at `normal`, or at the preset that it names.
TEST(Resolve, APresetChangesWhatTheSceneSaysInTheSameMeasure) {
  Scene scene = bare_scene();
  scene.defaults.given.set(&Quality::samples, 64);
  scene.defaults.given.set(&Quality::emission_records, 12'000'000);
  scene.defaults.given.set(&Quality::patch_length, 2);
  scene.defaults.given.set(&Quality::element_length, 1);
  scene.defaults.given.set(&Quality::refine, 6);
  scene.defaults.given.set(&Quality::shadow_rays, false);
  const Quality fine = quality_of(scene, "fine");
  EXPECT_EQ(fine.samples, 256U);
  EXPECT_EQ(fine.emission_records, 48'000'000U);
  EXPECT_EQ(fine.patch_length, 1.0);
  EXPECT_EQ(fine.element_length, 0.8);
  EXPECT_EQ(fine.cluster_factor, 0.625) << "half of normal's length, as patches";
  EXPECT_EQ(fine.refine, 6.0);
  EXPECT_FALSE(fine.shadow_rays);
  const Quality draft = quality_of(scene, "draft");
  EXPECT_EQ(draft.samples, 8U);
  EXPECT_EQ(draft.emission_records, 1'500'000U);
  EXPECT_EQ(draft.patch_length, 4.0);
  EXPECT_EQ(draft.element_length, 2.0);
  EXPECT_EQ(draft.refine, 0.0);
  EXPECT_FALSE(draft.shadow_rays);
  scene.defaults.quality = PlacedText{"fine", ""};
  EXPECT_EQ(quality_of(scene, "fine").samples, 64U);
  EXPECT_EQ(quality_of(scene, "normal").samples, 16U);
}

// `fine` has no final gathering, so a scene that names it says nothing of that for other presets, unless by itself.
TEST(Resolve, ASceneAtFineIsGatheredAtOtherPresets) {
  Scene scene = bare_scene();
  scene.defaults.quality = PlacedText{"fine", ""};
  EXPECT_EQ(quality_of(scene, "fine").final_gather, 0U);
  for (const Preset& preset : kPresets) {
    EXPECT_EQ(quality_of(scene, preset.name.data()).final_gather, preset.gathering.final_gather);
    EXPECT_EQ(quality_of(scene, preset.name.data()).emission_records, preset.gathering.emission_records);
  }
  scene.defaults.given.set(&Quality::final_gather, 64);
  EXPECT_EQ(quality_of(scene, "normal").final_gather, 64U);
}

TEST(Resolve, PresetsSendNoShadowRaysToLargeEmitters) {
  Scene scene = bare_scene();
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 3, 0}};
  scene.materials.resize(2);
  scene.materials[1].emission = {1, 1, 1};
  scene.triangles.resize(2);
  scene.triangles[0].position = {0, 1, 2};
  scene.triangles[1].position = {0, 1, 3};
  scene.triangles[1].material = 1;
  EXPECT_FALSE(quality_of(scene, "fine").shadow_rays) << "three quarters of all surface emit";
  RenderOptions options;
  options.preset = preset_named("fine");
  options.given.set(&Quality::shadow_rays, true);
  EXPECT_TRUE(resolve(options, scene).quality.shadow_rays) << "asked for";
  scene.defaults.given.set(&Quality::shadow_rays, true);
  EXPECT_TRUE(quality_of(scene, "fine").shadow_rays) << "the scene asks for them";
  scene.defaults.given.forget(&Quality::shadow_rays);
  scene.positions[3] = {0, 0.1, 0};
  EXPECT_TRUE(quality_of(scene, "fine").shadow_rays) << "a tenth";
}

/// A square metre that is diffuse, and of the other material so much.
Scene scene_with_other_surface(const SceneMaterial& other, double square_metres) {
  Scene scene = bare_scene();
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 2 * square_metres, 0}};
  scene.materials.resize(2);
  scene.materials[1] = other;
  scene.triangles.resize(2);
  scene.triangles[0].position = {0, 1, 2};
  scene.triangles[1].position = {0, 1, 3};
  scene.triangles[1].material = 1;
  return scene;
}

TEST(Resolve, PresetsHaveFinalGatheringWhereHardlyAnySurfaceTurnsLight) {
  SceneMaterial mirror;
  mirror.kind = SurfaceKind::mirror;
  SceneMaterial glass;
  glass.kind = SurfaceKind::glass;
  SceneMaterial glossy;
  glossy.specular = {0, 0.1, 0};
  SceneMaterial pane = glass;
  pane.thin = true;
  for (const auto& [name, preset] : {std::pair{"draft", kPresets[0]}, {"normal", kPresets[1]}, {"fine", kPresets[2]}}) {
    for (const Scene& scene : {scene_with_other_surface(mirror, 0.005), scene_with_other_surface(glass, 0.005),
                               scene_with_other_surface(glossy, 0.005), scene_with_other_surface(pane, 1)}) {
      const Quality quality = quality_of(scene, name);
      EXPECT_EQ(quality.final_gather, preset.gathering.final_gather);
      EXPECT_EQ(quality.shot_points, preset.gathering.shot_points);
      EXPECT_EQ(quality.emission_records, preset.gathering.emission_records);
    }
    for (const SceneMaterial& turning : {mirror, glass, glossy}) {
      const Quality quality = quality_of(scene_with_other_surface(turning, 0.02), name);
      EXPECT_EQ(quality.final_gather, 0U);
      EXPECT_EQ(quality.shot_points, preset.quality.shot_points);
      EXPECT_EQ(quality.emission_records, preset.quality.emission_records);
    }
  }
}

// 0 asks for a preset's own records; any other number for that and no more.
TEST(Resolve, FinalGatheringThatIsGivenChoosesThePresetsRecords) {
  Scene scene = scene_with_other_surface({}, 1);
  RenderOptions options;
  options.given.set(&Quality::final_gather, 0);
  EXPECT_EQ(resolve(options, scene).quality.shot_points, Quality{}.shot_points);
  options.given.set(&Quality::final_gather, 64);
  EXPECT_EQ(resolve(options, scene).quality.final_gather, 64U);
  EXPECT_EQ(resolve(options, scene).quality.shot_points, kPresets[1].gathering.shot_points);
  scene.defaults.given.set(&Quality::final_gather, 0);
  EXPECT_EQ(resolve(options, scene).quality.final_gather, 64U) << "the user outweighs the scene";
  EXPECT_EQ(quality_of(scene, "draft").shot_points, kPresets[0].quality.shot_points);
  EXPECT_EQ(quality_of(scene, "draft").final_gather, 0U);
  scene.defaults.given.set(&Quality::final_gather, kPresets[1].gathering.final_gather / 4);
  EXPECT_EQ(quality_of(scene, "draft").final_gather, kPresets[0].gathering.final_gather / 4);
}

// Who wants so many shots, or so many records of each, looks at what they bring.
TEST(Resolve, PresetsGatherNothingBehindShotsThatAreGiven) {
  for (const auto member : {&Quality::max_shots, &Quality::shot_points, &Quality::emission_records}) {
    Scene scene = scene_with_other_surface({}, 1);
    RenderOptions options;
    options.given.set(member, 10);
    EXPECT_EQ(resolve(options, scene).quality.final_gather, 0U);
    EXPECT_EQ(resolve(options, scene).quality.hemicube, Quality{}.hemicube);
    options.given.set(&Quality::final_gather, 48);
    EXPECT_EQ(resolve(options, scene).quality.final_gather, 48U) << "asked for";
    scene.defaults.given.set(member, 10);
    EXPECT_EQ(quality_of(scene, "draft").final_gather, 0U);
  }
  const Scene scene = scene_with_other_surface({}, 1);
  RenderOptions no_limit;
  no_limit.given.set(&Quality::max_shots, 0);
  EXPECT_EQ(resolve(no_limit, scene).quality.final_gather, kPresets[1].gathering.final_gather);
}

// Clusters are not refined, so they do not grow with elements that are; a length that is given is theirs, too.
TEST(Resolve, ClustersAreAsFineAsPatches) {
  EXPECT_EQ(quality_of(bare_scene(), "normal").cluster_factor, 1.0);
  EXPECT_EQ(quality_of(bare_scene(), "draft").cluster_factor, 1.0);
  EXPECT_EQ(quality_of(bare_scene(), "fine").cluster_factor, 0.625);
  RenderOptions options;
  options.preset = preset_named("fine");
  options.given.set(&Quality::element_length, 0.5);
  EXPECT_EQ(resolve(options, bare_scene()).quality.cluster_factor, 1.0);
}

TEST(Resolve, FaultsOfTheSceneNameTheirPlace) {
  Scene scene = scene_with_defaults();
  scene.defaults.subspaces = PlacedText{"2x3", "room/scene.toml:7"};
  EXPECT_THAT(message_of<InputError>([&] { resolve({}, scene); }),
              testing::StartsWith("room/scene.toml:7: [defaults] 'subspaces'"));
  scene = scene_with_defaults();
  scene.defaults.allocation = PlacedText{"heaps", "room/scene.toml:8"};
  EXPECT_THAT(message_of<InputError>([&] { resolve({}, scene); }), HasSubstr("heaps"));
  Scene fair = scene_with_defaults();
  fair.defaults.quality = PlacedText{"good", "room/scene.toml:9"};
  EXPECT_THAT(message_of<InputError>([&] { resolve({}, fair); }),
              testing::AllOf(testing::StartsWith("room/scene.toml:9: [defaults] 'quality'"), HasSubstr("good")));
  RenderOptions options;
  options.given.set(&MachineChoice::allocation, "block");
  EXPECT_NO_THROW(resolve(options, scene)) << "outweighed, so it does not matter";
}

TEST(Resolve, ACameraThatLooksNowhereIsRefused) {
  RenderOptions options;
  options.eye = {{0, 0, 0}};
  EXPECT_THROW(resolve(options, scene_with_defaults()), InputError);
  options.look_at = {{0, 1, 0}};
  EXPECT_THROW(resolve(options, scene_with_defaults()), InputError) << "along up";
  EXPECT_THROW(scene_options(options), InputError);
}

TEST(Resolve, AdaptiveSamplesAreForOnePicture) {
  RenderOptions options;
  options.given.set(&Quality::most_samples, 64U);
  EXPECT_NO_THROW(resolve(options, bare_scene()));
  options.display.display = true;
  EXPECT_THAT(message_of<UsageError>([&] { resolve(options, bare_scene()); }), HasSubstr("--most-samples"));
}

TEST(Resolve, MissingMachineFileIsRefused) {
  RenderOptions options;
  options.machine = "/nowhere/machine.toml";
  EXPECT_THROW(resolve(options, bare_scene()), InputError);
}

}  // namespace
}  // namespace torolux
