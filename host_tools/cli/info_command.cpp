// SPDX-License-Identifier: MIT
// `torolux info SCENE`: options enter; what the scene holds and what a machine would need for it leaves. Runs nothing.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <numbers>

#include "emulator/errors.hpp"
#include "emulator/machine/network_memory.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/findings.hpp"
#include "host_tools/cli/firmware_image.hpp"
#include "host_tools/cli/measured_speed.hpp"
#include "host_tools/cli/own_scenes.hpp"
#include "host_tools/cli/resolve.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

constexpr std::size_t kLabel = 22;

void line(const std::string& label, const std::string& text) {
  std::cout << left(label, kLabel) << text << "\n";
}

std::string triple(const std::array<double, 3>& v) {
  return significant(v[0], 6) + " " + significant(v[1], 6) + " " + significant(v[2], 6);
}

std::string light_of(const Scene& scene, const SceneMaterial& material) {
  if (!emits(material)) return {};
  if (material.lamp == kNoMeasuredLamp) return "; emits " + triple(material.emission) + " W/(m^2 sr)";
  const double down = scene.lamps[material.lamp].share[0];
  return "; measured lamp, " + triple(vec::scale(material.emission, std::numbers::pi)) + " W/m^2 of its opening, " +
         significant(100 * down, 3) + " % from its front";
}

std::string describe(const SceneMaterial& material, const Scene& scene) {
  switch (material.kind) {
    case SurfaceKind::mirror:
      return "mirror, reflectance " + triple(material.specular);
    case SurfaceKind::glass:
      return std::string(material.thin ? "pane of thin glass" : "glass") + ", refractive index " +
             significant(material.refractive_index, 4) + ", transmittance " + triple(material.transmittance);
    case SurfaceKind::diffuse:
      break;
  }
  return "diffuse, reflectance " + triple(material.diffuse) +
         (material.texture != kNoImage ? " times " + scene.textures[material.texture].file : "") +
         (is_glossy(material)
              ? "; glossy, reflectance " + triple(material.specular) + ", exponent " + significant(material.exponent, 4)
              : "") +
         light_of(scene, material);
}

void print_bounds(const Scene& scene) {
  if (scene.positions.empty()) return;
  std::array<double, 3> low = scene.positions.front();
  std::array<double, 3> high = low;
  for (const auto& position : scene.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], position[axis]);
      high[axis] = std::max(high[axis], position[axis]);
    }
  }
  line("bounds", triple(low) + " to " + triple(high));
}

void print_scene(const Scene& scene) {
  std::vector<std::uint64_t> uses(scene.materials.size());
  std::uint64_t lights = 0;
  for (const SceneTriangle& triangle : scene.triangles) {
    ++uses[triangle.material];
    if (emits(scene.materials[triangle.material])) ++lights;
  }
  line("scene", scene.name);
  line("triangles", grouped(scene.triangles.size()) + ", " + grouped(lights) + " of them emit light");
  print_bounds(scene);
  line("materials", grouped(scene.materials.size()));
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    line("  " + scene.materials[i].name + " ",
         describe(scene.materials[i], scene) + "; " + grouped(uses[i]) + " triangles");
}

void print_plan(const RenderPlan& plan, const MachineChoice& machine) {
  line("patches", grouped(plan.patches) + ", elements " + grouped(plan.elements));
  const auto& cells = plan.subspaces;
  line("subspaces", std::to_string(cells[0]) + " x " + std::to_string(cells[1]) + " x " + std::to_string(cells[2]) +
                        ", " + grouped(plan.filled_subspaces) + " with anything in them, " + machine.allocation);
  if (machine.replicate != 0.0)
    line("on every PE", grouped(plan.radiosity_copies.cells) + " subspaces (" +
                            bytes_text(plan.radiosity_copies.bytes) + ") in the radiosity stage, " +
                            grouped(plan.ray_tracing_copies.cells) + " (" + bytes_text(plan.ray_tracing_copies.bytes) +
                            ") in the ray tracing stage");
  line("neighbours", fixed(plan.mean_neighbour_hops, 2) + " hops apart on average");
  line("PEs", std::to_string(machine.columns) + " x " + std::to_string(machine.rows) + " with " +
                  bytes_text(plan.local_memory_bytes) + " each");
  const NetworkMemory network = network_memory(machine.description);
  line("network memory per PE", "NIU " + bytes_text(network.niu()) + ", router " + bytes_text(network.router()));
  if (!plan.pe_bytes.empty()) {
    const auto [least, most] = std::minmax_element(plan.pe_bytes.begin(), plan.pe_bytes.end());
    std::uint64_t sum = 0;
    for (const std::uint64_t bytes : plan.pe_bytes) sum += bytes;
    line("memory needed per PE", "min " + bytes_text(*least) + ", mean " + bytes_text(sum / plan.pe_bytes.size()) +
                                     ", max " + bytes_text(*most));
  }
  const double hertz = machine.description.processor.clock_hertz;
  const Prediction& prediction = plan.prediction;
  const auto rounded = [](double value) { return grouped(static_cast<std::uint64_t>(value)); };
  if (prediction.draft_records > 0) {
    line("predicted draft", rounded(prediction.draft_records) + " records, " +
                                significant(prediction.draft_instructions, 2) + " instructions, " +
                                significant(prediction.draft_cycles, 2) + " cycles");
  }
  line("predicted work", rounded(prediction.records) + " records of " + grouped(prediction.shots) + " shots, " +
                             rounded(prediction.rays) + " camera rays, " + significant(prediction.instructions, 2) +
                             " instructions");
  const std::optional<double> slowness = measured_slowness(machine.engine);
  line("predicted time", significant(prediction.cycles(), 2) + " cycles, " + duration(prediction.cycles() / hertz) +
                             " of the machine's time; on " +
                             (slowness ? "this computer" : "a computer of 2020, as none was rendered here,") +
                             " some " + duration(prediction.wall_seconds * slowness.value_or(1)) + " (both rough)");
}

int run_info(const RenderOptions& options) {
  const Scene scene = load_scene(scene_named(options.scene), scene_options(options));
  const Resolved resolved = resolve(options, scene);
  print_scene(scene);
  std::vector<std::string> refusals;
  try {
    check_renderable(scene);
    const RenderPlan planned = plan(scene, resolved.camera, resolved.quality, resolved.machine, firmware_image());
    if (planned.patches > 0) print_plan(planned, resolved.machine);
    for (const std::string& note : planned.notes) line("note", note);
    refusals = planned.refusals;
  } catch (const InputError& error) {
    refusals.emplace_back(error.what());
  }
  for (const std::string& warning : scene.warnings) line("note", warning);
  const std::vector<std::string> findings = findings_before(scene, resolved);
  for (const std::string& finding : findings) line("note", finding);
  if (options.strict && !findings.empty()) refusals.emplace_back("by --strict: what the notes say of the scene");
  for (const std::string& refusal : refusals) line("would be refused", refusal);
  if (refusals.empty()) line("would be refused", "no");
  std::cout << std::flush;
  return 0;
}

}  // namespace

void add_info_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* command =
      app.add_subcommand("info", "Tell what a scene holds and what a machine needs for it; run nothing");
  add_scene_options(*command, *options);
  add_view_options(*command, *options);
  add_light_options(*command, *options);
  add_machine_options(*command, *options);
  add_engine_option(*command, *options);
  command->callback([options, &action] { action = [options] { return run_info(*options); }; });
}

}  // namespace torolux
