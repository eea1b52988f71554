// SPDX-License-Identifier: MIT
// `torolux lockstep IMAGE|SCENE`: an image or a scene enters; what both engines agreed in leaves, or where they part.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <fstream>
#include <iostream>
#include <memory>

#include "emulator/engines/lockstep/lockstep_engine.hpp"
#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/firmware_image.hpp"
#include "host_tools/cli/own_scenes.hpp"
#include "host_tools/cli/resolve.hpp"
#include "host_tools/report/progress_line.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/run/run.hpp"

namespace torolux {
namespace {

constexpr const char* kLockstep = "lockstep";

bool is_elf(const std::filesystem::path& file) {
  std::array<char, 4> magic{};
  std::ifstream stream(file, std::ios::binary);
  return stream.read(magic.data(), magic.size()) && magic == std::array<char, 4>{'\x7F', 'E', 'L', 'F'};
}

/// What says something about light, view or subspaces says nothing about an image.
void check_options_of_image(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    const bool common = option->get_positional() || name == "--pes" || name == "--pe-memory" || name == "--machine" ||
                        name == "--set" || name == "--threads" || name == "--quiet";
    if (option->count() != 0 && !common) throw UsageError(name + " is for scenes, and this is a firmware image");
  }
}

void run_image_in_lock_step(const RenderOptions& options) {
  MachineSetup setup;
  const MachineChoice& given = options.given.values().machine;
  if (options.given.has(&MachineChoice::columns)) {
    setup.columns = given.columns;
    setup.rows = given.rows;
  }
  setup.local_memory_bytes = given.pe_memory.value_or(setup.local_memory_bytes);
  setup.engine = kLockstep;
  setup.threads = given.threads;
  setup.interrupted = &interrupted;
  if (options.machine) setup.description = load_machine_description(*options.machine);
  for (const std::string& value : options.machine_values) set_machine_value(setup.description, value);
  const auto print = [&](const PeText& text) {
    if (!options.quiet) std::cout << "PE " << text.pe << " @ " << text.time << ": " << text.text << std::endl;
  };
  run_image(setup, load_image(options.scene), print, [](const Machine&, Cycles) { return !interrupted(); });
}

void render_in_lock_step(const RenderOptions& options) {
  const Scene scene = load_scene(scene_named(options.scene), scene_options(options));
  check_renderable(scene);
  if (!options.quiet)
    for (const std::string& warning : scene.warnings) std::cerr << "torolux: note: " << warning << "\n";
  Resolved resolved = resolve(options, scene);
  resolved.machine.engine = kLockstep;
  ProgressLine line(std::cerr, !options.quiet && ::isatty(STDERR_FILENO) == 1,
                    resolved.machine.description.processor.clock_hertz);
  render(scene, resolved.camera, resolved.quality, resolved.machine, {}, firmware_image(),
         [&line](const RenderProgress& progress) {
           if (!interrupted()) line.show(progress);
           return !interrupted();
         });
}

int run_lockstep(const RenderOptions& options, const CLI::App& command) {
  const auto begin = std::chrono::steady_clock::now();
  lockstep::Totals totals;
  register_engine(kLockstep, [&totals](const EngineSetup& setup) {
    lockstep::Options lockstep_options;
    lockstep_options.ended = [&totals](const lockstep::Totals& all) { totals = all; };
    return lockstep::make_engine(setup, lockstep_options);
  });
  if (is_elf(options.scene)) {
    check_options_of_image(command);
    run_image_in_lock_step(options);
  } else {
    render_in_lock_step(options);
  }
  if (interrupted()) return kInterrupted;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  std::cout << "QEMU and the translated engine agree: " << grouped(totals.hints) << " HINTs and "
            << grouped(totals.markers) << " phase markers at the same clocks, after the same "
            << grouped(totals.instructions) << " instructions; at every HINT the same local memory ("
            << bytes_text(totals.bytes) << " compared in all); " << duration(wall.count()) << std::endl;
  return 0;
}

}  // namespace

void add_lockstep_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* command =
      app.add_subcommand(kLockstep, "Run both engines side by side and compare them at every HINT; writes no picture");
  add_scene_options(*command, *options, "IMAGE|SCENE",
                    "A firmware image as for run, or a scene as for render: a folder with scene.toml, a .toml file, an "
                    ".obj or an .mgf file");
  command->add_flag("--quiet", options->quiet, "No progress, and not what the PEs say")->group("Results");
  add_view_options(*command, *options);
  add_light_options(*command, *options);
  add_machine_options(*command, *options);
  command->footer(
      "An image takes --pes, --pe-memory, --machine, --threads and --quiet alone. Where the engines differ, the exit "
      "code is 3, and the report says where and how they came there.");
  command->callback(
      [options, command, &action] { action = [options, command] { return run_lockstep(*options, *command); }; });
}

}  // namespace torolux
