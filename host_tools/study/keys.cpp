// SPDX-License-Identifier: MIT
// A point enters; it is resolved as its run would be, and the digest of that leaves.
#include "host_tools/study/keys.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "emulator/errors.hpp"
#include "host_tools/cli/prepared_render.hpp"
#include "host_tools/cli/run_options.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/settings/options.hpp"
#include "host_tools/study/options.hpp"

namespace torolux::study {
namespace {

using Json = nlohmann::ordered_json;

/// Options of render and run whose effect stands in the settings beside those of the table. Any other one comes into
/// the key as it is written, so that an option that is forgotten here makes keys differ, never agree.
constexpr std::array<std::string_view, 24> kResolved = {
    "scene",   "image",  "studio", "missing-materials", "gltf-units", "camera",  "radiosity", "size",      "eye",
    "look-at", "up",     "fov",    "aperture",          "focus",      "quality", "pes",       "pe-memory", "subspaces",
    "machine", "engine", "ideal",  "qemu-pes",          "jitter",     "fault"};

bool resolved(const std::string& name) {
  const auto in_settings = [&name](const Option& option) { return option.name == "--" + name && !option.key.empty(); };
  return name.starts_with("machine.") || std::ranges::find(kResolved, name) != kResolved.end() ||
         std::ranges::any_of(all_options(), in_settings);
}

std::vector<std::string> after_command(const std::vector<std::string>& words) {
  return {words.begin() + 1, words.end()};
}

Json render_settings(const std::vector<std::string>& words, double& work) {
  const PreparedRender prepared = prepare_render(parse_render_options(after_command(words)));
  const Quality& quality = prepared.run.quality;
  work = static_cast<double>(quality.emission_records) * (1 + quality.refine) +
         static_cast<double>(quality.width) * quality.height * quality.samples;
  return settings_json(prepared.run, nullptr);
}

Json run_settings(const std::vector<std::string>& words, double& work) {
  const RunOptions options = parse_run_options(after_command(words));
  const MachineSetup setup = setup_from(options);
  work = static_cast<double>(setup.columns) * setup.rows;
  return settings_json(setup, program_files(options, setup, read_inputs(options.program.inputs)));
}

/// Options by name, which has an order of its own.
Json written(const Plan& plan, const Point& point, bool all) {
  std::vector<PlanOption> options = point.options;
  std::ranges::sort(options, {}, &PlanOption::name);
  Json json = Json::object();
  for (const PlanOption& option : options) {
    if (!all && resolved(option.name)) continue;
    json[option.name] =
        option.name == "machine" ? sha256_of_file(plan.file.parent_path() / option.value) : option.value;
  }
  return json;
}

KeyedRun resolve_run(const Plan& plan, const Point& point, const std::string& program) {
  KeyedRun run;
  run.words = words_of(plan, point.options);
  Json material = {{"program", program}, {"command", plan.command}};
  const bool has_settings = plan.command == "render" || plan.command == "run";
  if (plan.command == "render") run.settings = determining(render_settings(run.words, run.work)).dump();
  if (plan.command == "run") run.settings = determining(run_settings(run.words, run.work)).dump();
  material["settings"] = run.settings;
  material["options"] = written(plan, point, !has_settings);
  run.key = sha256(material.dump());
  return run;
}

}  // namespace

std::string program_digest() {
  return sha256_of_file("/proc/self/exe");
}

KeyedRun keyed_run(const Plan& plan, const Point& point, const std::string& program) {
  const auto place = [&] { return point.place.text() + ": " + label_of(point, varied_names(plan)) + ": "; };
  try {
    return resolve_run(plan, point, program);
  } catch (const UsageError& error) {
    throw InputError(place() + error.what());
  } catch (const InputError& error) {
    throw InputError(place() + error.what());
  }
}

}  // namespace torolux::study
