// SPDX-License-Identifier: MIT
// Adds the options to a subcommand: name, form, unit, range, default. The ranges of values stand here and nowhere else.
#include "host_tools/cli/render_options.hpp"

#include <CLI/CLI.hpp>
#include <string_view>
#include <utility>

#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "emulator/nearest_name.hpp"
#include "firmware/protocol/stores.hpp"
#include "host_tools/cli/named_value.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/picture/picture.hpp"
#include "host_tools/render/render.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/subspace/allocation.hpp"

namespace torolux {
namespace {

constexpr std::string_view kAllocations =
    "skewed, skewed:AB (A, B two of x, y, z), skewed-both, modulo, block, balanced";

/// Adds an option whose text goes through `parse`; errors name the option.
template <class Parse>
CLI::Option* add_value(CLI::App& command, const std::string& name, const std::string& form, const std::string& help,
                       Parse parse) {
  const auto take = [name, parse](const std::string& text) { value_of(name, parse, text); };
  return command.add_option_function<std::string>(name, take, help)
      ->type_name(form)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

/// Adds a whole number that lands in `value`.
template <class Integer>
CLI::Option* add_count(CLI::App& command, const std::string& name, const std::string& help,
                       std::optional<Integer>& value, std::uint64_t least, std::uint64_t most, std::uint64_t built_in) {
  return add_value(command, name, "N", help,
                   [&value, least, most](const std::string& text) {
                     value = static_cast<Integer>(parse_count(text, least, most));
                   })
      ->default_str(std::to_string(built_in));
}

std::string joined(const auto& names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

void take_path(std::optional<std::filesystem::path>& to, const std::string& text) {
  if (text.empty()) throw UsageError("the name is empty");
  to = text;
}

}  // namespace

void check_allocation(const std::string& name) {
  if (is_allocation(name)) return;
  const std::string near = did_you_mean(name, {"skewed", "skewed-both", "modulo", "block", "balanced"});
  throw UsageError("\"" + name + "\" is no allocation" + near + (near.empty() ? "; there are: " : " There are: ") +
                   std::string(kAllocations));
}

void add_scene_options(CLI::App& command, RenderOptions& options, const std::string& name, const std::string& help) {
  command.add_option(name, options.scene, help)->required()->type_name("")->group("Scene");
  command.add_flag("--studio", options.studio, "Put the mesh into a room with a lamp, both fitted to it")
      ->group("Scene");
  add_value(command, "--missing-materials", "refuse|white",
            "Materials, libraries and textures that are nowhere: refused, or white in their place",
            [&options](const std::string& text) { options.missing_materials = parse_missing_materials(text); })
      ->default_str("refuse")
      ->group("Scene");
  command
      .add_flag(
          "--strict", options.strict,
          "Refuse what else is told: what in the scene's files is passed over or read as something near, and what "
          "looks as if it was not meant so")
      ->group("Scene");
}

void add_tone_options(CLI::App& command, ToneOptions& options, const std::string& group) {
  add_value(command, "--exposure", "EV",
            "Exposure of a .png in EV (1 is twice as bright); 0 shows the picture's "
            "middle luminance as middle grey",
            [&options](const std::string& text) { options.exposure_ev = parse_number(text, -50, 50); })
      ->default_str("0")
      ->group(group);
  add_value(command, "--tone-curve", "NAME",
            "Of a .png: filmic (toe and shoulder, keeps hue), or linear (what is too bright is cut off)",
            [&options](const std::string& text) { options.curve = parse_tone_curve(text); })
      ->default_str("filmic")
      ->group(group);
}

void add_output_options(CLI::App& command, RenderOptions& options) {
  const std::string group = "Results";
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
  add_value(
      command, "--layers", "LIST",
      "What else the picture shows, as channels of an .exr and as a .png each beside a .png: elements, irradiance, "
      "depth, normals, owner (PE), cost (subspaces visited); or all",
      [&options](const std::string& text) { options.layers = parse_layers(text); })
      ->group(group);
  add_tone_options(command, options.tone, group);
  path("--stats", "Statistics of the run, as JSON", options.stats);
  command.add_option("--stats-csv", options.stats_csv, "The same as tables (.csv), into this folder")
      ->type_name("FOLDER")
      ->group(group);
  path("--report", "The run as one .html page: picture, maps, time line, what limits each stage", options.report);
  path("--save-radiosity", "Keep the result of the radiosity stage in this file", options.save_radiosity);
  path("--save-mesh", "The solved elements with the radiosity at their corners, as .ply", options.save_mesh);
  path("--radiosity", "Take the result of the radiosity stage from this file: only the view changes",
       options.radiosity);
  command.add_flag("--quiet", options.quiet, "No progress, no notes, no summary; errors only")->group(group);
  command.add_flag("--verbose", options.verbose, "Progress tells of credits, too")->group(group);
}

void add_view_options(CLI::App& command, RenderOptions& options) {
  const std::string group = "View";
  const Quality built_in;
  add_value(command, "--size", "WxH", "Picture size in pixels",
            [&options](const std::string& text) { options.size = parse_pair(text, 1, kMostPictureEdge); })
      ->default_str(std::to_string(built_in.width) + "x" + std::to_string(built_in.height))
      ->group(group);
  add_count(command, "--samples", "Rays per pixel", options.samples, 1, kMostSamples, built_in.samples)->group(group);
  add_value(
      command, "--filter", "NAME",
      "How what lies around a pixel's middle weighs in it: box (its square alone), tent (to the middles of the next "
      "pixels), gaussian (softer)",
      [&options](const std::string& text) { options.filter = parse_filter(text); })
      ->default_str(std::string(name_of(built_in.filter)))
      ->group(group);
  const auto vector = [&](const std::string& name, const std::string& help, auto& to) {
    add_value(command, name, "X,Y,Z", help, [&to](const std::string& text) { to = parse_vector(text); })->group(group);
  };
  vector("--eye", "Where the camera is, in scene units [the scene's]", options.eye);
  vector("--look-at", "A point that it looks at, in scene units [the scene's]", options.look_at);
  vector("--up", "Direction that is up in the picture [the scene's, else 0,1,0]", options.up);
  add_value(command, "--fov", "DEGREES", "Vertical field of view, degrees [the scene's, else 40]",
            [&options](const std::string& text) { options.field_of_view_degrees = parse_number(text, 0.01, 179); })
      ->group(group);
}

void add_light_options(CLI::App& command, RenderOptions& options) {
  const std::string group = "Quality";
  const Quality built_in;
  const auto length = [&](const std::string& name, const std::string& help, std::optional<LengthOption>& to) {
    add_value(command, name, "LENGTH|auto", help,
              [&to](const std::string& text) { to = LengthOption{parse_length(text)}; })
        ->default_str("auto")
        ->group(group);
  };
  add_value(command, "--quality", "NAME",
            "Settings that belong together: draft, normal or fine. Whatever else is given outweighs it",
            [&options](const std::string& text) { options.preset = parse_preset(text); })
      ->default_str("normal")
      ->group(group);
  length("--patches", "Longest edge of a patch (which shoots light), scene units", options.patches);
  length("--elements", "Longest edge of an element (which receives light), scene units", options.elements);
  add_value(command, "--refine", "FACTOR",
            "Elements added where a draft of the light asks for it, as a multiple of those without; 0: no draft",
            [&options](const std::string& text) { options.refine = parse_number(text, 0, 100); })
      ->default_str(significant(built_in.refine, 6))
      ->group(group);
  add_value(command, "--hemicube", "N",
            "Pixels across the top of a hemi-cube, even, 4 to " + std::to_string(protocol::kMostHemicubeSize),
            [&options](const std::string& text) {
              const auto pixels = parse_count(text, 4, protocol::kMostHemicubeSize);
              if (pixels % 2 != 0) throw InputError("\"" + text + "\" is odd; the number must be even");
              options.hemicube = static_cast<std::uint32_t>(pixels);
            })
      ->default_str(std::to_string(built_in.hemicube))
      ->group(group);
  add_value(command, "--shot-points", "K",
            "K x K points per patch from which it shoots, 1 to " + std::to_string(protocol::kMostShotPoints),
            [&options](const std::string& text) {
              options.shot_points = static_cast<std::uint32_t>(parse_count(text, 1, protocol::kMostShotPoints));
            })
      ->default_str(std::to_string(built_in.shot_points))
      ->group(group);
  add_count(command, "--emission-records", "Records with which all emitters together begin, about, 0 to 1e9",
            options.emission_records, 0, kMostEmissionRecords, built_in.emission_records)
      ->group(group);
  add_value(command, "--unshot", "FRACTION",
            "The radiosity stage ends when less than this fraction of the emitted "
            "flux is unshot",
            [&options](const std::string& text) { options.unshot = parse_number(text, 1e-9, 1); })
      ->default_str(significant(built_in.unshot, 6))
      ->group(group);
  add_count(command, "--max-shots", "Or after this many patches have shot; 0: no limit", options.max_shots, 0,
            0xFFFF'FFFFU, built_in.max_shots)
      ->group(group);
  add_count(command, "--bounces",
            "Path segments after which light is cut off, 1 to " + std::to_string(protocol::kMostBounces),
            options.bounces, 1, protocol::kMostBounces, built_in.bounces)
      ->group(group);
  add_count(command, "--texels", "Texels of each texture, at most; larger images are averaged", options.texels, 1,
            kMostTexels, built_in.texels)
      ->group(group);
  add_value(command, "--direct", "HOW",
            "Light straight from emitters, at diffuse surfaces: shadow-rays (one from each point that is seen: sharp "
            "shadows), or radiosity (from the elements: no noise; chosen where much of the scene emits)",
            [&options](const std::string& text) { options.shadow_rays = parse_direct(text); })
      ->default_str("shadow-rays")
      ->group(group);
  command.add_flag("--two-sided-lights", options.two_sided_lights, "Emitters emit from both sides")->group(group);
  add_count(command, "--seed", "Seed of all random numbers", options.seed, 0, ~std::uint64_t{0}, built_in.seed)
      ->group(group);
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
  const std::string group = kMachineGroup;
  const MachineChoice built_in;
  add_value(command, "--pes", "PxQ", "PEs of the torus, columns x rows",
            [&options](const std::string& text) { options.pes = parse_pes(text); })
      ->default_str(std::to_string(built_in.columns) + "x" + std::to_string(built_in.rows))
      ->group(group);
  add_value(command, "--pe-memory", "SIZE",
            "Local memory of a PE in bytes, K = 1024, M = 1024 K; 256K to 64M [the "
            "smallest power of two from 1M that fits]",
            [&options](const std::string& text) { options.pe_memory = parse_memory(text); })
      ->group(group);
  add_value(command, "--subspaces", "GxHxK|auto", "Subspaces along x, y, z",
            [&options](const std::string& text) { options.subspaces = SubspacesOption{parse_subspaces(text)}; })
      ->default_str("auto")
      ->group(group);
  add_value(
      command, "--scheme", "NAME",
      "How the scene and the work are shared out: spread (copies of what is hot on every PE, work dealt to whoever "
      "has little), or paper (as published: owners shoot, every face between PEs is a hand-over)",
      [&options](const std::string& text) { options.scheme = parse_scheme(text); })
      ->default_str(std::string(name_of(built_in.scheme)))
      ->group(group);
  add_value(command, "--allocation", "NAME",
            "Which PE holds which subspace: " + std::string(kAllocations) + " [balanced; --scheme paper: skewed]",
            [&options](const std::string& text) {
              check_allocation(text);
              options.allocation = text;
            })
      ->group(group);
  add_value(command, "--replicate", "FRACTION|auto",
            "Most of a PE's memory for copies of subspaces that stand on every PE, 0 to 1; auto: what fits [auto; "
            "--scheme paper: 0]",
            [&options](const std::string& text) { options.replicate = ReplicateOption{parse_fraction(text)}; })
      ->group(group);
  add_value(command, "--points", "travel|stay",
            "A shot's points are expanded by whoever has little work, or by the patch's owner [travel; --scheme "
            "paper: stay]",
            [&options](const std::string& text) { options.points = parse_points(text); })
      ->group(group);
  add_value(command, "--empty", "over|enter",
            "Rays step over empty subspaces by themselves, or stop in each [over; --scheme paper: enter]",
            [&options](const std::string& text) { options.empty = parse_empty(text); })
      ->group(group);
  add_value(command, "--camera-rays", "pes|host",
            "PEs make the camera rays of tiles dealt to them, or the host does [pes; --scheme paper: host]",
            [&options](const std::string& text) { options.camera_rays = parse_ray_maker(text); })
      ->group(group);
  command
      .add_flag(
          "--enter-empty", options.enter_empty,
          "Camera rays of the host begin in the outermost subspace on their way, not in the first one with anything "
          "in it")
      ->group(group);
  add_value(command, "--machine", "FILE.toml", "Parameters of the machine [built in]",
            [&options](const std::string& text) { take_path(options.machine, text); })
      ->group(group);
  add_machine_values_option(command, options.machine_values, group);
  add_ideal_option(command, options.ideal, group);
  add_fault_options(command, options.faults, group);
  add_value(
      command, "--threads", "N", "Threads of this computer that work for the machine [all cores]",
      [&options](const std::string& text) { options.threads = static_cast<std::uint32_t>(parse_count(text, 1, 4096)); })
      ->group(group);
}

void add_engine_option(CLI::App& command, RenderOptions& options) {
  add_value(command, "--engine", "NAME", "What runs the PEs: " + joined(engine_names()),
            [&options](const std::string& text) {
              engine_named(text);
              options.engine = text;
            })
      ->default_str(kDefaultEngine)
      ->group(kMachineGroup);
}

}  // namespace torolux
