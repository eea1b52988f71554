// SPDX-License-Identifier: MIT
// bash as a child, in the folder.
#include "tests/kit/shell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "emulator/engines/engine_names.hpp"
#include "host_tools/files/shell_line.hpp"
#include "host_tools/study/child.hpp"

namespace torolux::test {
namespace {

std::filesystem::path built_programs() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

/// What PEs did, engine and host apart.
nlohmann::json figures_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  nlohmann::json all = nlohmann::json::parse(stream);
  for (const char* const key : {"engine", "settings", "command_line", "wall_seconds", "host"}) all.erase(key);
  return all;
}

}  // namespace

UserFolder::UserFolder(std::filesystem::path program_folder)
    : program_folder_(program_folder.empty() ? built_programs() : std::move(program_folder)) {}

void UserFolder::write(const std::string& file, std::string_view text) const {
  std::filesystem::create_directories((path() / file).parent_path());
  std::ofstream(path() / file) << text;
}

Said UserFolder::run(const std::string& lines) const {
  const std::string begin = "set -euo pipefail; " + shell_line({"cd", path().string()}) +
                            "; PATH=" + shell_line({program_folder_.string()}) + ":$PATH; ";
  study::Child bash("bash", {"-c", begin + lines});
  study::Ended ended = bash.wait();
  return {ended.exit_code, std::move(ended.output), std::move(ended.errors)};
}

std::string UserFolder::succeed(const std::string& lines) const {
  Said said = run(lines);
  EXPECT_EQ(said.exit_code, 0) << lines << "\n" << said.output << said.errors;
  return std::move(said.output);
}

std::string said_on_all_engines(const UserFolder& folder, const std::string& image, const std::string& options) {
  std::string first;
  nlohmann::json figures;
  for (const std::string_view engine : engine_names()) {
    const std::string said = folder.succeed("torolux run " + image + " " + options +
                                            " --quiet --stats stats.json --engine " + std::string(engine));
    const nlohmann::json of_engine = figures_of(folder.path() / "stats.json");
    if (engine == engine_names().front()) {
      first = said;
      figures = of_engine;
    }
    EXPECT_EQ(said, first) << image << " on " << engine;
    EXPECT_EQ(of_engine, figures) << image << " on " << engine;
  }
  return first;
}

std::string texts_of(const std::string& output) {
  std::istringstream lines(output);
  std::vector<std::string> texts;
  for (std::string line; std::getline(lines, line);)
    texts.push_back(line.substr(std::min(line.find(": ") + 2, line.size())));
  std::ranges::sort(texts);
  std::string all;
  for (const std::string& text : texts) all += text + "\n";
  return all;
}

}  // namespace torolux::test
