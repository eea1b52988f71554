// SPDX-License-Identifier: MIT
// The folder of a study: one file for each result, named by its key.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host_tools/study/keys.hpp"

namespace torolux::study {

using Json = nlohmann::ordered_json;

class ResultFolder {
 public:
  /// command: of the plan. render and run leave statistics (KEY.json), others a CSV of one row (KEY.csv).
  ResultFolder(std::filesystem::path folder, std::string command)
      : folder_(std::move(folder)), command_(std::move(command)) {}

  const std::filesystem::path& path() const { return folder_; }
  /// Throws InputError.
  void make() const;
  /// A CSV comes on standard output.
  bool from_output() const { return command_ != "render" && command_ != "run"; }
  std::filesystem::path file(const std::string& key) const;
  std::filesystem::path lock(const std::string& key) const { return folder_ / (key + ".lock"); }

  /// Absent: not run yet, or what lies there is not whole. A CSV's columns become keys. Throws InputError for
  /// statistics of another run.
  std::optional<Json> read(const KeyedRun& run) const;

 private:
  std::filesystem::path folder_;
  std::string command_;
};

/// All words after `torolux` that leave the result in the folder, and nothing else anywhere.
std::vector<std::string> words_for_result(const KeyedRun& run, const ResultFolder& folder, unsigned threads);
/// The same with another file for statistics.
std::vector<std::string> words_for_result(const KeyedRun& run, const ResultFolder& folder, unsigned threads,
                                          const std::filesystem::path& file);

/// What a render or run has left. Absent where it is no JSON object. settings: of the run that it should be of
/// (KeyedRun). Throws InputError, which names the file: of another.
std::optional<Json> statistics_of(const std::string& text, const std::string& settings, const std::string& file);

/// Header and row; numbers where they read as such. Absent where there is not just one row.
std::optional<Json> row_of_csv(const std::string& text);

}  // namespace torolux::study
