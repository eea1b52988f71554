// SPDX-License-Identifier: MIT
// `torolux inspect SCENE`: a question about a pixel, a PE or an element enters; the answer leaves, as text and JSON.
// The scene is rendered for it.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/firmware_image.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/prepared_render.hpp"
#include "host_tools/cli/table_options.hpp"
#include "host_tools/files/distinct_files.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/inspect/answer_json.hpp"
#include "host_tools/inspect/answer_text.hpp"
#include "host_tools/inspect/inspector.hpp"
#include "host_tools/inspect/packet_log.hpp"
#include "host_tools/render/session.hpp"
#include "host_tools/report/progress_line.hpp"

namespace torolux {
namespace {

constexpr const char* kGroup = "What is asked, and what comes out";
constexpr std::uint64_t kMostNumber = 0xFFFF'FFFE;

struct InspectOptions {
  RenderOptions render;
  std::optional<FollowedPixel> pixel;
  std::optional<unsigned> pe;
  std::optional<std::uint32_t> element;
  std::optional<FollowedPixel> element_at;
  std::optional<std::filesystem::path> json, view;
};

FollowedPixel parse_pixel(const std::string& text) {
  const bool pixel = text.find(',') != std::string::npos;
  if (!pixel) throw InputError("\"" + text + "\" is not a pixel: X,Y or X,Y:SAMPLE, counted from 0");
  return std::get<FollowedPixel>(parse_follow(text));
}

void take_element(InspectOptions& options, const std::string& text) {
  if (text.find(',') == std::string::npos) {
    options.element = static_cast<std::uint32_t>(parse_count(text, 0, kMostNumber));
  } else {
    options.element_at = parse_pixel(text);
  }
}

void add_questions(CLI::App& command, InspectOptions& options) {
  const auto add = [&](const std::string& name, const std::string& form, const std::string& help, auto take) {
    add_value(command, name, form, help, take)->group(kGroup);
  };
  const auto add_file = [&](const std::string& name, const std::string& help, auto& to) {
    add(name, "FILE", help, [&to](const std::string& text) {
      if (text.empty()) throw UsageError("the name is empty");
      to = text;
    });
  };
  add("--pixel", "X,Y", "The story of a ray, of the pixel's sample 0 or of X,Y:SAMPLE, all counted from 0",
      [&options](const std::string& text) { options.pixel = parse_pixel(text); });
  add("--pe", "N", "A PE: its subspaces, memory, queues, phases, last packets",
      [&options](const std::string& text) { options.pe = static_cast<unsigned>(parse_count(text, 0, kMostNumber)); });
  add("--element", "N|X,Y", "An element, by number or as it is seen in a pixel: radiosity, area, owner, its light",
      [&options](const std::string& text) { take_element(options, text); });
  add_file("--json", "The answers, as JSON", options.json);
  add_file("--view", "A picture (.png, .exr, .pfm) of the scene with what each of its elements holds", options.view);
  add_file("--radiosity", "Take the result of the radiosity stage from this file", options.render.radiosity);
  command.add_flag("--quiet", options.render.quiet, "No progress; answers and errors only")->group(kGroup);
}

void check_pixel(const FollowedPixel& pixel, const Quality& quality) {
  if (pixel.column < quality.width && pixel.row < quality.height && pixel.sample < quality.samples) return;
  throw InputError("the picture has " + std::to_string(quality.width) + " x " + std::to_string(quality.height) +
                   " pixels of " + std::to_string(quality.samples) + " samples, all counted from 0");
}

/// What can be known before the work.
void check_questions(const InspectOptions& options, const PreparedRender& prepared) {
  if (!options.pixel && !options.pe && !options.element && !options.element_at && !options.view)
    throw UsageError("nothing is asked: --pixel, --pe, --element or --view");
  const Resolved& resolved = prepared.resolved;
  if (options.pixel) check_pixel(*options.pixel, resolved.quality);
  if (options.element_at) check_pixel(*options.element_at, resolved.quality);
  const unsigned pes = resolved.machine.columns * resolved.machine.rows;
  if (options.pe && *options.pe >= pes)
    throw InputError("--pe: there is no PE " + std::to_string(*options.pe) + "; the machine has 0 to " +
                     std::to_string(pes - 1));
  std::vector<NamedFile> written, read;
  if (options.json) written.push_back({"--json", *options.json});
  if (options.view) written.push_back({"--view", *options.view});
  for (const InputFile& input : prepared.run.inputs.files) read.push_back({"a file that is read", input.path});
  check_distinct(written, read);
  if (options.json) check_file_writable(*options.json);
  if (options.view) check_writable(*options.view);
}

/// Prints one answer, and keeps it for the file.
template <class Answer>
void give(const char* name, const Answer& answer, nlohmann::ordered_json& all) {
  std::cout << answer_text(answer);
  all[name] = answer_json(answer);
}

void answer(const InspectOptions& options, const Inspector& inspector, const Story* story, const PacketLog* log,
            const RenderResult& result, const ToneMapping& tone) {
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  if (options.pixel) give("pixel", inspector.pixel(*options.pixel, *story, result.picture), all);
  if (options.pe) give("pe", inspector.pe(*options.pe, log->packets()), all);
  std::optional<std::uint32_t> element = options.element;
  if (options.element_at) {
    element = inspector.element_at(options.element_at->column, options.element_at->row);
    if (!element) throw InputError("--element: no lit element is seen in that pixel");
  }
  if (element) give("element", inspector.element(*element), all);
  std::cout << std::flush;
  if (options.json) write_file(*options.json, all.dump(2) + "\n");
  if (options.view) write_picture(inspector.picture(), *options.view, tone);
}

int run_inspect(const InspectOptions& options) {
  PreparedRender prepared = prepare_render(options.render);
  Resolved& resolved = prepared.resolved;
  check_questions(options, prepared);
  std::optional<Story> story;
  std::optional<PacketLog> log;
  if (options.pixel) resolved.machine.follower = &story.emplace(*options.pixel);
  if (options.pe) resolved.machine.follower = &log.emplace(*options.pe, resolved.machine.follower);
  ProgressLine line(std::cerr, !options.render.quiet && ::isatty(STDERR_FILENO) == 1,
                    resolved.machine.description.processor.clock_hertz);
  const std::function<bool(const RenderProgress&)> progress = [&line](const RenderProgress& present) {
    if (interrupted()) return false;
    line.show(present);
    return true;
  };
  RenderSession session(prepared.scene, resolved.camera, resolved.quality, resolved.machine, resolved.files,
                        firmware_image(), progress);
  const RenderResult result = session.run(Machine::Then::end);
  line.wipe();
  if (interrupted()) return kInterrupted;
  const Inspector inspector({prepared.scene, resolved.camera, resolved.quality, resolved.machine, session.setup(),
                             session.solution(), result.figures.machine});
  answer(options, inspector, story ? &*story : nullptr, log ? &*log : nullptr, result, resolved.tone);
  return 0;
}

}  // namespace

void add_inspect_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<InspectOptions>();
  CLI::App* command = app.add_subcommand("inspect", "Render a scene and answer about a pixel, a PE, an element");
  add_scene_options(*command, options->render);
  add_questions(*command, *options);
  add_view_options(*command, options->render);
  add_light_options(*command, options->render);
  add_machine_options(*command, options->render);
  add_engine_option(*command, options->render);
  command->callback([options, &action] { action = [options] { return run_inspect(*options); }; });
}

}  // namespace torolux
