// SPDX-License-Identifier: MIT
// Proves: the settings in the statistics are whole. The command line made of them leads to the very same settings, for
// options by chance, scenes with and without settings of their own, and machines by chance.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "emulator/errors.hpp"
#include "host_tools/cli/prepared_render.hpp"
#include "host_tools/cli/run_options.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/scene/camera.hpp"
// After GoogleTest, which it does not include itself.
#include <rapidcheck/gtest.h>

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

/// Of the whole range in every trial, not near its start in the first ones.
template <class Integer>
Integer whole(std::uint64_t least, std::uint64_t most) {
  return static_cast<Integer>(*rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::uint64_t>(least, most + 1)));
}

/// Any number from least to most, with all its bits.
double real(double least, double most) {
  const auto bits = whole<std::uint64_t>(0, std::uint64_t{1} << 53U);
  return least + (most - least) * (static_cast<double>(bits) * 0x1p-53);
}

/// Calls `set` in every second case.
template <class Set>
void perhaps(Set set) {
  if (*rc::gen::arbitrary<bool>()) set();
}

std::array<double, 3> place() {
  return {real(-1e3, 1e3), real(-1e3, 1e3), real(-1e3, 1e3)};
}

std::optional<double> length() {
  return *rc::gen::arbitrary<bool>() ? std::optional(real(1e-3, 10)) : std::nullopt;
}

std::string allocation() {
  return *rc::gen::element<std::string>("skewed", "skewed:zy", "skewed-both", "modulo", "block", "balanced");
}

std::string preset() {
  return *rc::gen::element<std::string>("draft", "normal", "fine");
}

SceneDefaults any_defaults() {
  SceneDefaults d;
  perhaps([&] { d.quality = PlacedText{preset(), ""}; });
  perhaps([&] { d.given.set(&Quality::width, whole<std::uint32_t>(1, 4096)); });
  perhaps([&] { d.given.set(&Quality::samples, whole<std::uint32_t>(1, 65536)); });
  perhaps([&] { d.given.set(&Quality::hemicube, 2 * whole<std::uint32_t>(2, 128)); });
  perhaps([&] { d.given.set(&Quality::shot_points, whole<std::uint32_t>(1, 64)); });
  perhaps([&] { d.given.set(&Quality::emission_records, whole<std::uint32_t>(0, 1'000'000'000)); });
  perhaps([&] { d.given.set(&ToneMapping::exposure_ev, real(-50, 50)); });
  perhaps([&] { d.given.set(&Quality::patch_length, real(1e-3, 10)); });
  perhaps([&] { d.given.set(&Quality::element_length, real(1e-3, 10)); });
  perhaps([&] { d.given.set(&Quality::refine, real(0, 100)); });
  perhaps([&] { d.given.set(&Quality::unshot, *rc::gen::element(0.0, 1e-10, real(0, 1))); });
  perhaps([&] { d.subspaces = PlacedText{"2x3x4", ""}; });
  perhaps([&] { d.allocation = PlacedText{allocation(), ""}; });
  perhaps([&] { d.given.set(&Quality::two_sided_lights, *rc::gen::arbitrary<bool>()); });
  perhaps([&] { d.given.set(&Quality::shadow_rays, *rc::gen::arbitrary<bool>()); });
  return d;
}

void any_light(RenderOptions& o) {
  perhaps([&] { o.preset = preset_named(preset()); });
  perhaps([&] { o.given.set(&Quality::patch_length, length()); });
  perhaps([&] { o.given.set(&Quality::element_length, length()); });
  perhaps([&] { o.given.set(&Quality::hemicube, 2 * whole<std::uint32_t>(2, 128)); });
  perhaps([&] { o.given.set(&Quality::shot_points, whole<std::uint32_t>(1, 64)); });
  perhaps([&] { o.given.set(&Quality::emission_records, whole<std::uint32_t>(0, 1'000'000'000)); });
  perhaps([&] { o.given.set(&Quality::max_shots, whole<std::uint32_t>(0, 0xFFFF'FFFFU)); });
  perhaps([&] { o.given.set(&Quality::bounces, whole<std::uint32_t>(1, 255)); });
  perhaps([&] { o.given.set(&Quality::texels, whole<std::uint32_t>(1, kMostTexels)); });
  perhaps([&] { o.given.set(&Quality::refine, real(0, 100)); });
  perhaps([&] { o.given.set(&Quality::unshot, real(1e-9, 1)); });
  perhaps([&] { o.given.set(&Quality::seed, whole<std::uint64_t>(0, ~std::uint64_t{0} - 1)); });
  perhaps([&] { o.given.set(&Quality::shadow_rays, *rc::gen::arbitrary<bool>()); });
  perhaps([&] { o.given.set(&Quality::two_sided_lights, true); });
}

void any_view(RenderOptions& o) {
  perhaps([&] {
    o.given.set(&Quality::width, whole<std::uint32_t>(1, 32768));
    o.given.set(&Quality::height, whole<std::uint32_t>(1, 32768));
  });
  perhaps([&] { o.given.set(&Quality::samples, whole<std::uint32_t>(1, 65536)); });
  perhaps([&] {
    o.given.set(&Quality::filter, *rc::gen::element(PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian));
  });
  perhaps([&] { o.eye = place(); });
  perhaps([&] { o.look_at = place(); });
  perhaps([&] { o.up = place(); });
  perhaps([&] { o.field_of_view_degrees = real(0.01, 179); });
  perhaps([&] { o.aperture = real(0, 2); });
  perhaps([&] { o.focus = real(0.1, 10); });
  perhaps([&] { o.given.set(&ToneMapping::exposure_ev, real(-50, 50)); });
  perhaps([&] { o.given.set(&ToneMapping::curve, ToneCurve::linear); });
  perhaps([&] {
    o.given.set(&ToneMapping::white, *rc::gen::element(WhiteBalance{WhiteBalance::Kind::automatic, 0},
                                                       WhiteBalance{WhiteBalance::Kind::kelvin, real(1000, 40000)}));
  });
  LayerSet layers = 0;
  for (const LayerName& layer : kLayerNames) perhaps([&] { layers |= protocol::plane_bit(layer.plane); });
  o.given.set(&Quality::layers, layers);
}

/// Of every third key a value that the key can have, or one that it has from the start.
std::vector<std::string> any_machine_values() {
  std::vector<std::string> values;
  for (const MachineSetting& built_in : machine_description_values({})) {
    if (whole<int>(0, 2) != 0) continue;
    MachineValue value = built_in.value;
    if (bool* flag = std::get_if<bool>(&value)) *flag = !*flag;
    if (auto* number = std::get_if<std::uint64_t>(&value)) *number += whole<std::uint64_t>(0, 3);
    if (double* number = std::get_if<double>(&value)) *number += real(0, 0.1);
    MachineDescription scratch;
    const std::string assignment = built_in.key + "=" + text_of(value);
    try {
      set_machine_value(scratch, assignment);
    } catch (const InputError&) {
      continue;  // beyond what is allowed
    }
    values.push_back(assignment);
  }
  return values;
}

void any_machine(RenderOptions& o) {
  perhaps([&] {
    o.given.set(&MachineChoice::columns, whole<std::uint32_t>(1, 255));
    o.given.set(&MachineChoice::rows, whole<std::uint32_t>(1, 255));
  });
  perhaps([&] { o.given.set(&MachineChoice::pe_memory, 4096 * whole<std::uint32_t>(64, 16384)); });
  perhaps([&] { o.given.set(&MachineChoice::subspaces, std::nullopt); });
  perhaps([&] { o.given.set(&MachineChoice::subspaces, {{whole<std::uint32_t>(1, 1024), 7, 9}}); });
  perhaps([&] { o.given.set(&MachineChoice::scheme, *rc::gen::element(Scheme::spread, Scheme::paper)); });
  perhaps([&] { o.given.set(&MachineChoice::allocation, allocation()); });
  perhaps([&] { o.given.set(&MachineChoice::replicate, real(0, 1)); });
  perhaps([&] { o.given.set(&MachineChoice::replicate, std::nullopt); });
  perhaps([&] { o.given.set(&MachineChoice::points, *rc::gen::element(Points::travel, Points::stay)); });
  perhaps([&] { o.given.set(&MachineChoice::empty, *rc::gen::element(Empty::over, Empty::enter)); });
  perhaps([&] { o.given.set(&MachineChoice::camera_rays, *rc::gen::element(RayMaker::pes, RayMaker::host)); });
  perhaps([&] { o.given.set(&MachineChoice::engine, "qemu"); });
  perhaps([&] { o.debugging.qemu_pes = {0, 1, 7}; });
  perhaps([&] { o.given.set(&MachineChoice::skip_empty_subspaces, false); });
  o.machine_values = any_machine_values();
}

Scene any_scene() {
  Scene scene;
  scene.name = "room";
  scene.camera = Camera{place(), place(), {0, 1, 0}, real(0.01, 179)};
  scene.defaults = any_defaults();
  return scene;
}

/// As a run would report them; files: of no disk.
Json settings_of(const RenderOptions& options, const Scene& scene) {
  std::vector<InputFile> files{{"scene", "room/scene.toml", sha256("room")}};
  if (options.radiosity) files.push_back({"radiosity", options.radiosity->string(), sha256("light")});
  return settings_json(describe(options, resolve(options, scene), scene.name, files), nullptr);
}

std::vector<std::string> after_command(std::vector<std::string> words) {
  words.erase(words.begin());
  return words;
}

RC_GTEST_PROP(Settings, OfARenderLeadToThemselves, ()) {
  const Scene scene = any_scene();
  RenderOptions options;
  options.scene = *rc::gen::element<std::string>("scenes/room", "a scene's room");
  options.studio = *rc::gen::arbitrary<bool>();
  options.missing_materials = *rc::gen::element(MissingMaterials::refuse, MissingMaterials::white);
  options.gltf_units = *rc::gen::element(GltfUnits::watt, GltfUnits::lumen);
  options.camera_name = *rc::gen::element<std::string>("", "Camera.001", "from the door");
  any_light(options);
  any_view(options);
  any_machine(options);
  perhaps([&] { options.radiosity = "room.rad"; });
  Camera camera = *scene.camera;
  camera.eye = options.eye.value_or(camera.eye);
  camera.look_at = options.look_at.value_or(camera.look_at);
  camera.up = options.up.value_or(camera.up);
  RC_PRE(!camera_fault(camera));
  const Json settings = settings_of(options, scene);
  const RenderOptions again = parse_render_options(after_command(command_line_of(Json::parse(settings.dump()))));
  const Json repeated = settings_of(again, scene);
  RC_ASSERT(repeated.dump(1) == settings.dump(1));
  RC_ASSERT(scene_options(again).camera.has_value() == scene_options(options).camera.has_value() || !options.studio);
}

RC_GTEST_PROP(Settings, OfAnImageLeadToThemselves, ()) {
  RunOptions options;
  options.images.others = *rc::gen::element<std::string>("hello.elf", "a b.elf");
  perhaps([&] { options.pes = "3x5"; });
  perhaps([&] { options.pe_memory = "256K"; });
  options.machine_values = any_machine_values();
  perhaps([&] { options.program.arguments = {"-x", "two words", "--pes"}; });
  perhaps([&] { options.program.inputs = {{"data", "some file"}, {"stdin", "a=b"}}; });
  perhaps([&] { options.program.outputs = {{"out", "/dev/null"}}; });
  perhaps([&] { options.ending.until = 123'456'789'012; });
  ProgramFiles files{InputFile{"image", options.images.others, sha256("image")}, {}, {}};
  for (const GivenFile& input : options.program.inputs) {
    files.read.push_back({"input " + input.name, input.file.string(), sha256("input")});
  }
  for (const GivenFile& output : options.program.outputs) files.outputs.push_back(output.name);
  const Json settings = settings_json(setup_from(options), files);
  const RunOptions again = parse_run_options(after_command(command_line_of(Json::parse(settings.dump()))));
  RC_ASSERT(settings_json(setup_from(again), files).dump(1) == settings.dump(1));
  RC_ASSERT(again.program.inputs.size() == options.program.inputs.size());
  RC_ASSERT(again.program.outputs.size() == options.program.outputs.size());
}

TEST(Settings, HoldEveryKeyOfTheMachine) {
  MachineDescription description;
  set_machine_value(description, "torus.link_error_rate=0.1");
  MachineSetup setup;
  setup.description = description;
  const Json machine = settings_json(setup, {InputFile{"image", "a.elf", ""}, {}, {}}).at("machine");
  for (const std::string& key : machine_description_keys()) {
    std::string pointer = "/" + key;
    std::ranges::replace(pointer, '.', '/');
    EXPECT_TRUE(machine.contains(Json::json_pointer(pointer))) << key;
  }
  EXPECT_EQ(machine["torus"]["link_error_rate"].dump(), "0.1");
  EXPECT_EQ(machine.flatten().size(), machine_description_keys().size());
}

TEST(Settings, WhatDeterminesARunIsKnownBeforeIt) {
  RunDescription run;
  run.inputs.scene_path = "here/room";
  run.inputs.files = {{"scene", "here/room/scene.toml", sha256("room")}};
  const Json before = determining(settings_json(run, nullptr));
  RenderFigures figures;
  figures.local_memory_bytes = 1U << 20U;
  figures.subspaces = {8, 8, 8};
  EXPECT_EQ(determining(settings_json(run, &figures)), before);
  run.inputs.scene_path = "there/room";
  run.inputs.files[0].path = "there/room/scene.toml";
  EXPECT_EQ(determining(settings_json(run, nullptr)), before) << "a scene that has moved is the same";
  run.inputs.files[0].sha256 = sha256("another room");
  EXPECT_NE(determining(settings_json(run, nullptr)), before);
}

TEST(Settings, ThatAreNotWholeAreRefused) {
  EXPECT_THROW(command_line_of(Json::object()), InputError);
  EXPECT_THROW(command_line_of(Json{{"command", "render"}}), InputError);
  EXPECT_THROW(command_line_of(Json{{"command", "paint"}}), InputError);
  EXPECT_THROW(command_line_of(Json("text")), InputError);
}

}  // namespace
}  // namespace torolux
