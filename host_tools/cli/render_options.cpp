// SPDX-License-Identifier: MIT
// Adds the options to a subcommand: those of the table, and by hand those that are not settings of one value.
#include "host_tools/cli/render_options.hpp"

#include <CLI/CLI.hpp>
#include <string_view>
#include <utility>

#include "emulator/errors.hpp"
#include "host_tools/cli/growing_options.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/table_options.hpp"
#include "host_tools/picture/picture.hpp"
#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {
namespace {

void take_path(std::optional<std::filesystem::path>& to, const std::string& text) {
  if (text.empty()) throw UsageError("the name is empty");
  to = text;
}

}  // namespace

void add_scene_options(CLI::App& command, RenderOptions& options, const std::string& name, const std::string& help) {
  command.add_option(name, options.scene, help)->required()->type_name("")->group("Scene");
  command.add_flag("--studio", options.studio, "Put the mesh into a room with a lamp, both fitted to it")
      ->group("Scene");
  add_value(command, "--missing-materials", "refuse|white",
            "Materials, libraries and textures that are nowhere: refused, or white in their place",
            [&options](const std::string& text) { options.missing_materials = parse_missing_materials(text); })
      ->default_str("refuse")
      ->group("Scene");
  add_value(command, "--gltf-units", "watt|lumen",
            "Light of glTF files: numbers as they are (1 cd is 1 W/sr), or divided by 683 lm/W",
            [&options](const std::string& text) { options.gltf_units = parse_gltf_units(text); })
      ->default_str("watt")
      ->group("Scene");
  command
      .add_flag(
          "--strict", options.strict,
          "Refuse what else is told: what in the scene's files is passed over or read as something near, and what "
          "looks as if it was not meant so")
      ->group("Scene");
}

void add_tone_options(CLI::App& command, GivenSettings& given, const std::string& group) {
  add_table_option(command, option_of(&ToneMapping::exposure_ev), given)->group(group);
  add_table_option(command, option_of(&ToneMapping::curve), given)->group(group);
  add_table_option(command, option_of(&ToneMapping::white), given)->group(group);
}

void add_output_options(CLI::App& command, RenderOptions& options) {
  const std::string group = heading(OptionGroup::results);
  const auto path = [&](const std::string& name, const std::string& help, auto& to) {
    return add_value(command, name, "FILE", help, [&to](const std::string& text) { take_path(to, text); })
        ->group(group);
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--output",
          [&options](const std::vector<std::string>& names) {
            for (const std::string& name : names) {
              if (name.empty()) throw UsageError("--output: the name is empty");
              options.outputs.emplace_back(name);
            }
          },
          "Picture: .png (8 bits, sRGB, tone-mapped), .exr or .pfm (linear radiance, W/(m^2 sr)). May be repeated [the "
          "scene's name with .png, in the current folder]")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(group);
  command.add_flag("--no-picture", options.no_picture, "Write no picture: for the statistics alone")->group(group);
  add_table_options(command, OptionGroup::results, options.given);
  path("--stats", "Statistics of the run, as JSON", options.stats);
  command.add_option("--stats-csv", options.stats_csv, "The same as tables (.csv), into this folder")
      ->type_name("FOLDER")
      ->group(group);
  path("--report", "The run as one .html page: picture, maps, time line, what limits each stage", options.report);
  path("--profile", "Of the firmware: call paths and their cycles, one a line (docs/profile.md); --engine interpreted",
       options.profile);
  add_value(command, "--follow", "X,Y|SHOT:POINT",
            "Tell one record's story: of a pixel's sample (X,Y or X,Y:SAMPLE) or of a direction of a shot's point "
            "(SHOT:POINT or SHOT:POINT:DIRECTION), all counted from 0",
            [&options](const std::string& text) { options.follow = parse_follow(text); })
      ->group(group);
  path("--save-radiosity", "Keep the result of the radiosity stage in this file", options.save_radiosity);
  path("--save-mesh", "The solved elements with the radiosity at their corners, as .ply", options.save_mesh)
      ->type_name("FILE.ply");
  path("--radiosity", "Take the result of the radiosity stage from this file: only the view changes",
       options.radiosity);
  add_growing_options(command, options.growing, group);
  command.add_flag("--quiet", options.quiet, "No progress, no notes, no summary; errors only")->group(group);
  command.add_flag("--verbose", options.verbose, "Progress tells of credits, too")->group(group);
}

void add_view_options(CLI::App& command, RenderOptions& options) {
  const std::string group = heading(OptionGroup::view);
  const Quality built_in;
  const auto take_size = [&options](const std::string& text) {
    const auto [width, height] = parse_pair(text, 1, kMostPictureEdge);
    options.given.set(&Quality::width, width);
    options.given.set(&Quality::height, height);
  };
  add_value(command, "--size", "WxH", "Picture size in pixels", take_size)
      ->default_str(std::to_string(built_in.width) + "x" + std::to_string(built_in.height))
      ->group(group);
  add_table_options(command, OptionGroup::view, options.given);
  const auto vector = [&](const std::string& name, const std::string& help, auto& to) {
    add_value(command, name, "X,Y,Z", help, [&to](const std::string& text) { to = parse_vector(text); })->group(group);
  };
  add_value(command, "--camera", "NAME", "One of the cameras that the scene's glTF files bring along [the first]",
            [&options](const std::string& text) {
              if (text.empty()) throw UsageError("the name is empty");
              options.camera_name = text;
            })
      ->group(group);
  vector("--eye", "Where the camera is, in scene units [the scene's]", options.eye);
  vector("--look-at", "A point that it looks at, in scene units [the scene's]", options.look_at);
  vector("--up", "Direction that is up in the picture [the scene's, else 0,1,0]", options.up);
  add_value(command, "--fov", "DEGREES", "Vertical field of view, degrees [the scene's, else 40]",
            [&options](const std::string& text) { options.field_of_view_degrees = parse_number(text, 0.01, 179); })
      ->group(group);
  add_value(command, "--aperture", "DIAMETER",
            "Diameter of the camera's lens, scene units: what is not in focus is blurred; 0: all is sharp [the "
            "scene's, else 0]",
            [&options](const std::string& text) { options.aperture = parse_number(text, 0, kMostCoordinate); })
      ->group(group);
  add_value(command, "--focus", "DISTANCE|X,Y,Z",
            "Where the lens is sharp: a distance along the view, or a point, in scene units [the scene's, else the "
            "point that it looks at]",
            [&options](const std::string& text) {
              if (text.find(',') == std::string::npos)
                options.focus = parse_number(text, 0, kMostCoordinate);
              else
                options.focus = parse_vector(text);
            })
      ->group(group);
  command
      .add_option(
          "--path", options.path,
          "A picture from each camera of this file, numbered (NAME.0001.png, ...): an animation of one solved scene")
      ->type_name("FILE")
      ->group(group);
}

void add_light_options(CLI::App& command, RenderOptions& options) {
  add_value(command, "--quality", "NAME",
            "Settings that belong together: draft, normal or fine. Whatever else is given outweighs it",
            [&options](const std::string& text) { options.preset = parse_preset(text); })
      ->default_str("normal")
      ->group(heading(OptionGroup::quality));
  add_table_options(command, OptionGroup::quality, options.given);
}

void add_machine_values_option(CLI::App& command, std::vector<std::string>& values, const std::string& group) {
  const auto take = [&values](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      MachineDescription scratch;
      try {
        set_machine_value(scratch, text);
      } catch (const UsageError& error) {
        throw UsageError(std::string("--set: ") + error.what());
      } catch (const InputError& error) {
        throw InputError("--set " + text + ": " + error.what());
      }
      values.push_back(text);
    }
  };
  CLI::Option* option = command.add_option_function<std::vector<std::string>>(
      "--set", take, "One parameter of the machine, like torus.flit_bytes=16; outweighs --machine. May be repeated");
  option->type_name("KEY=VALUE")->allow_extra_args(false);
  if (!group.empty()) option->group(group);
}

void add_machine_options(CLI::App& command, RenderOptions& options) {
  const std::string group = heading(OptionGroup::machine);
  const MachineChoice built_in;
  const auto take_pes = [&options](const std::string& text) {
    const auto [columns, rows] = parse_pes(text);
    options.given.set(&MachineChoice::columns, columns);
    options.given.set(&MachineChoice::rows, rows);
  };
  add_value(command, "--pes", "PxQ", "PEs of the torus, columns x rows", take_pes)
      ->default_str(std::to_string(built_in.columns) + "x" + std::to_string(built_in.rows))
      ->group(group);
  add_table_options(command, OptionGroup::machine, options.given);
  add_value(command, "--machine", "FILE.toml", "Parameters of the machine [built in]",
            [&options](const std::string& text) { take_path(options.machine, text); })
      ->group(group);
  add_machine_values_option(command, options.machine_values, group);
  add_ideal_option(command, options.ideal, group);
  add_fault_options(command, options.faults, group);
  add_table_option(command, option_of(&MachineChoice::threads), options.given);
}

void add_engine_option(CLI::App& command, RenderOptions& options) {
  add_table_option(command, option_of(&MachineChoice::engine), options.given);
}

}  // namespace torolux
