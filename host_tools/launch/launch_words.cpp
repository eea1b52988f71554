// SPDX-License-Identifier: MIT
// Words are taken out and put in front; nothing is left to a shell.
#include "host_tools/launch/launch_words.hpp"

#include <sstream>
#include <string_view>

#include "emulator/errors.hpp"
#include "emulator/ranks/launched.hpp"
#include "emulator/ranks/mpi_ranks.hpp"
#include "emulator/ranks/starter.hpp"

namespace torolux::launch {
namespace {

std::vector<std::string> words_between_blanks(const std::string& text) {
  std::istringstream parts(text);
  std::vector<std::string> words;
  for (std::string word; parts >> word;) words.push_back(word);
  return words;
}

/// What stands behind `--` is a program's own.
std::vector<std::string> words_of_ranks(const std::vector<std::string>& words) {
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (word == "--") return kept.insert(kept.end(), words.begin() + static_cast<std::ptrdiff_t>(i), words.end()), kept;
    if (word.starts_with("--ranks=") || word.starts_with("--launcher=")) continue;
    if (word == "--ranks" || word == "--launcher")
      ++i;  // and its value
    else
      kept.emplace_back(word);
  }
  return kept;
}

}  // namespace

std::vector<std::string> launch_words(const LaunchChoice& choice, const std::string& program,
                                      const std::vector<std::string>& words) {
  // Asked in any case: without MPI whatever launcher would start the same work several times.
  std::vector<std::string> all = ranks::mpi_launcher();
  if (!choice.launcher.empty()) all = words_between_blanks(choice.launcher);
  if (all.empty()) throw UsageError("--launcher: there are only blanks");
  all.insert(all.end(), {"-n", std::to_string(choice.ranks), program});
  const std::vector<std::string> own = words_of_ranks(words);
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

std::vector<std::string> launch_environment(const std::string& socket_name) {
  std::vector<std::string> variables = ranks::environment_of_no_rank();
  variables.push_back(std::string(ranks::kStarterVariable) + "=" + socket_name);
  return variables;
}

}  // namespace torolux::launch
