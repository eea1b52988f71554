// SPDX-License-Identifier: MIT
// A run is known again by its settings, the digests of its inputs, and the program that makes it.
#include "host_tools/cli/checkpoint_options.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "emulator/errors.hpp"
#include "emulator/niu/processor_side.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/same_run.hpp"
#include "host_tools/cli/table_options.hpp"
#include "host_tools/report/settings_json.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMostRounds = 1'000'000;
constexpr double kMostMinutes = 100'000;
/// Differences that are told, of a run that is another one.
constexpr std::size_t kMostTold = 4;

Json identity_of(const RunDescription& run) {
  Json settings = settings_json(run, nullptr);
  for (const char* of_the_picture_file : {"exposure", "tone_curve", "white_balance"})
    settings.erase(of_the_picture_file);
  return {{"settings", std::move(settings)}, {"layout", niu_channel_layout()}};
}

std::vector<std::string> differences(const Json& was, const Json& is) {
  std::vector<std::string> lines = changed_inputs(was.at("settings"), is.at("settings"));
  for (const auto& more : {changed_settings(was.at("settings"), is.at("settings")),
                           changed_versions(was.at("settings"), is.at("settings"))}) {
    lines.insert(lines.end(), more.begin(), more.end());
  }
  if (lines.empty() && was.at("layout") != is.at("layout")) lines.emplace_back("the program was built otherwise");
  return lines;
}

void check_same(const std::string& file, const std::string& saved, const Json& is) {
  std::vector<std::string> lines;
  try {
    lines = differences(Json::parse(saved), is);
  } catch (const Json::exception& error) {
    throw InputError(file + ": damaged: " + error.what());
  }
  if (lines.empty()) return;
  std::string text;
  for (std::size_t i = 0; i < lines.size() && i < kMostTold; ++i) text += (i == 0 ? "" : "; ") + lines[i];
  if (lines.size() > kMostTold) text += "; and " + std::to_string(lines.size() - kMostTold) + " more";
  throw InputError(file + ": a checkpoint of another run: " + text + ". Give the options with which it was written");
}

}  // namespace

void add_checkpoint_options(CLI::App& command, CheckpointOptions& options, const std::string& group) {
  const auto add = [&](const std::string& name, const std::string& form, const std::string& help, auto parse) {
    return add_value(command, name, form, help, parse)->group(group);
  };
  const auto add_path = [&](const std::string& name, const std::string& help, auto& to) {
    add(name, "FILE", help, [&to](const std::string& text) {
      if (text.empty()) throw UsageError("the name is empty");
      to = text;
    });
  };
  add_path("--checkpoint", "Keep the state of the run in this file: now and then, at Ctrl-C, and at the end",
           options.file);
  add("--checkpoint-rounds", "N", "A checkpoint every so many rounds of the radiosity stage, too [none]",
      [&options](const std::string& text) { options.rounds = parse_count(text, 1, kMostRounds); });
  add("--checkpoint-minutes", "M", "A checkpoint every so many minutes; 0: none for that",
      [&options](const std::string& text) { options.minutes = parse_number(text, 0, kMostMinutes); })
      ->default_str("5");
  static_assert(kCheckpointMinutes == 5);
  add_path("--resume", "Go on from this checkpoint of the same run; the other options as they were", options.resume);
}

CheckpointChoice checkpoint_choice(const CheckpointOptions& options, const RunDescription& run) {
  if (!options.file) {
    if (options.rounds || options.minutes)
      throw UsageError("--checkpoint-... says when there is a checkpoint; --checkpoint FILE says where it goes");
    return {};
  }
  CheckpointChoice choice;
  choice.file = options.file;
  choice.rounds = static_cast<std::uint32_t>(options.rounds.value_or(0));
  choice.minutes = options.minutes.value_or(kCheckpointMinutes);
  choice.interrupted = &interrupted;
  choice.identity = identity_of(run).dump();
  return choice;
}

std::unique_ptr<CheckpointReader> checkpoint_to_resume(const CheckpointOptions& options, const RunDescription& run) {
  if (!options.resume) return nullptr;
  auto reader = std::make_unique<CheckpointReader>(*options.resume);
  check_same(options.resume->string(), reader->identity(), identity_of(run));
  return reader;
}

}  // namespace torolux
