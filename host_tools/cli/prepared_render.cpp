// SPDX-License-Identifier: MIT
// Words or options enter; a scene, settings and their description leave.
#include "host_tools/cli/prepared_render.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/debugging_options.hpp"
#include "host_tools/cli/findings.hpp"
#include "host_tools/cli/firmware_image.hpp"
#include "host_tools/cli/own_scenes.hpp"
#include "host_tools/cli/parse_words.hpp"
#include "host_tools/cli/table_options.hpp"
#include "host_tools/scene/recorded_files.hpp"

namespace torolux {

void add_render_options(CLI::App& command, RenderOptions& options) {
  add_scene_options(command, options);
  add_output_options(command, options);
  add_view_options(command, options);
  add_light_options(command, options);
  add_machine_options(command, options);
  add_engine_option(command, options);
  add_debugging_options(command, options.debugging, heading(OptionGroup::machine));
  add_rank_options(command, options.ranks, heading(OptionGroup::machine));
  add_trace_options(command, options.trace, TracedRun::render, "Trace");
  add_display_options(command, options.display, "Display");
  add_checkpoint_options(command, options.checkpoint, "Saving and going on");
}

RenderOptions parse_render_options(const std::vector<std::string>& words) {
  RenderOptions options;
  CLI::App command;
  add_render_options(command, options);
  parse_words(command, words);
  return options;
}

PreparedRender prepare_render(const RenderOptions& options) {
  RecordedFiles recorded;
  PreparedRender prepared;
  prepared.scene = load_scene_from(recorded, scene_named(options.scene), scene_options(options));
  check_renderable(prepared.scene);
  prepared.resolved = resolve(options, prepared.scene);
  prepared.resolved.machine.interrupted = &interrupted;
  prepared.findings = findings_before(prepared.scene, prepared.resolved);
  if (options.strict) refuse_what_is_told(prepared.findings);
  std::vector<InputFile> files = recorded.files();
  if (options.radiosity)
    files.push_back({"radiosity", options.radiosity->string(), sha256_of_file(*options.radiosity)});
  if (options.path) files.push_back({"path", options.path->string(), sha256_of_file(*options.path)});
  files.push_back({"firmware", "pe.elf", sha256_of_file(firmware_image())});
  prepared.run = describe(options, prepared.resolved, prepared.scene.name, std::move(files));
  return prepared;
}

}  // namespace torolux
