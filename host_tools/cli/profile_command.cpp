// SPDX-License-Identifier: MIT
// `torolux profile IMAGE.elf`: options enter; what `torolux run` leaves, and where the PEs' cycles have gone.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/run_options.hpp"
#include "host_tools/cli/table_options.hpp"
#include "host_tools/files/distinct_files.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/profile/profile_json.hpp"
#include "host_tools/profile/profile_text.hpp"
#include "host_tools/profile/speedscope.hpp"

namespace torolux {
namespace {

constexpr std::uint64_t kMostRows = 1'000'000;

struct ProfileOptions {
  RunOptions run;
  std::vector<unsigned> pes;  ///< of these alone; empty: of all
  std::size_t most = 30;
  std::optional<std::filesystem::path> json, csv, folded, speedscope;
};

std::vector<std::pair<const char*, std::filesystem::path>> files_of(const ProfileOptions& options) {
  std::vector<std::pair<const char*, std::filesystem::path>> files;
  const auto add = [&files](const char* name, const std::optional<std::filesystem::path>& file) {
    if (file) files.emplace_back(name, *file);
  };
  add("--json", options.json);
  add("--csv", options.csv);
  add("--folded", options.folded);
  add("--speedscope", options.speedscope);
  return files;
}

/// Throws InputError where a result cannot be written, or would be written over another.
void check_results(const ProfileOptions& options, const RunImages& images) {
  std::vector<NamedFile> written = written_files(options.run.program);
  for (const auto& [name, file] : files_of(options)) {
    written.push_back({name, file});
    check_file_writable(file);
  }
  const RunOptions& run = options.run;
  if (run.stats) written.push_back({"--stats", *run.stats});
  if (run.trace.file) written.push_back({"--trace", *run.trace.file});
  if (run.report) written.push_back({"--report", *run.report});
  std::vector<NamedFile> read = read_files(run.program);
  for (const InputFile& image : images.files) read.push_back({"a file that is read", image.path});
  if (run.machine) read.push_back({"--machine", *run.machine});
  check_distinct(written, read);
}

std::vector<unsigned> chosen_pes(const ProfileOptions& options, std::size_t pes) {
  if (options.pes.empty()) {
    std::vector<unsigned> all(pes);
    std::iota(all.begin(), all.end(), 0U);
    return all;
  }
  if (options.pes.back() >= pes) {
    throw InputError("--pes-of: there is no PE " + std::to_string(options.pes.back()) + "; the machine has 0 to " +
                     std::to_string(pes - 1));
  }
  return options.pes;
}

void tell(const ProfileOptions& options, const std::string& name, const profile::CycleProfile& profile,
          const std::vector<unsigned>& pes) {
  const ProfileNames names(profile);
  const PathTree tree = paths_of(profile, names, pes);
  const ProfileTotals totals = totals_of(profile, names, pes, tree);
  std::cout << "\n" << profile_table(totals, names, pes.size(), options.most);
  if (tree.cut) {
    std::cerr << "torolux: note: some call paths were too many or too long to be kept whole: total % of some functions "
                 "is too small\n";
  }
  if (options.json) write_file(*options.json, profile_json(totals, names, pes));
  if (options.csv) write_file(*options.csv, profile_csv(totals, names));
  if (options.folded) write_file(*options.folded, folded_paths(tree, names));
  if (options.speedscope) {
    FileWriter file(*options.speedscope);
    write_speedscope(profile, names, pes, name,
                     [&file](std::string_view text) { file.append(std::as_bytes(std::span(text))); });
    file.finish();
  }
}

int run_profile(const ProfileOptions& options) {
  const MachineSetup setup = setup_from(options.run);
  const std::vector<unsigned> pes = chosen_pes(options, std::size_t{setup.columns} * setup.rows);
  const RunImages images = images_of(options.run.images, setup.columns * setup.rows);
  check_results(options, images);
  profile::CycleProfile profile;
  RunOptions run = options.run;
  run.profile = &profile;
  run.profile_for_report = [&] {
    const ProfileNames names(profile);
    return flame_graph_json(paths_of(profile, names, pes), names, pes.size());
  };
  RunEnd end;
  try {
    end = run_prepared(run);
  } catch (const MachineFailure&) {
    if (profile.pes() != 0) tell(options, images.names(), profile, pes);  // up to there
    throw;
  }
  if (!interrupted()) tell(options, images.names(), profile, pes);
  return end.exit_code;
}

}  // namespace

void add_profile_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<ProfileOptions>();
  CLI::App* command = app.add_subcommand("profile", "Run a firmware image and tell which functions its cycles go to");
  options->run.engine = kInterpretedEngine;
  add_run_options(*command, options->run);
  command->remove_option(command->get_option("--engine"));  // the one that knows each instruction
  add_value(*command, "--pes-of", "LIST", "Of the profile: these PEs alone, like 0-3,7 [all]",
            [options](const std::string& text) { options->pes = parse_pe_list(text); });
  add_value(*command, "--most", "N", "Rows of the table, at most", [options](const std::string& text) {
    options->most = parse_count(text, 1, kMostRows);
  })->default_str(std::to_string(options->most));
  command->add_option("--json", options->json, "The whole table, as JSON")->type_name("FILE");
  command->add_option("--csv", options->csv, "The whole table, as .csv")->type_name("FILE");
  command
      ->add_option("--folded", options->folded, "Call paths and their cycles, one a line, as flamegraph.pl reads them")
      ->type_name("FILE");
  command->add_option("--speedscope", options->speedscope, "Call paths of each PE, for www.speedscope.app")
      ->type_name("FILE");
  command->callback([options, &action] { action = [options] { return run_profile(*options); }; });
}

}  // namespace torolux
