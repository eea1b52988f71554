// SPDX-License-Identifier: MIT
// Result files into JSON.
#include "host_tools/study/results.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

#include "emulator/errors.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/study/options.hpp"

namespace torolux::study {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

Json value_of(const std::string& cell) {
  std::uint64_t whole = 0;
  const char* end = cell.data() + cell.size();
  if (const auto result = std::from_chars(cell.data(), end, whole); result.ec == std::errc() && result.ptr == end)
    return whole;
  double number = 0;
  if (const auto result = std::from_chars(cell.data(), end, number); result.ec == std::errc() && result.ptr == end)
    return number;
  return cell;
}

}  // namespace

void ResultFolder::make() const {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error || !std::filesystem::is_directory(folder_))
    throw InputError(folder_.string() + ": no folder can be made there" + (error ? ": " + error.message() : ""));
}

std::filesystem::path ResultFolder::file(const std::string& key) const {
  return folder_ / (key + (from_output() ? ".csv" : ".json"));
}

std::optional<Json> ResultFolder::read(const KeyedRun& run) const {
  const std::filesystem::path name = file(run.key);
  std::ifstream stream(name, std::ios::binary);
  if (!stream) return std::nullopt;
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  return from_output() ? row_of_csv(text) : statistics_of(text, run.settings, name.string());
}

std::optional<Json> statistics_of(const std::string& text, const std::string& settings, const std::string& file) {
  Json result = Json::parse(text, nullptr, false);
  if (result.is_discarded() || !result.is_object()) return std::nullopt;
  bool same = false;
  try {
    same = result.contains("settings") && determining(result["settings"]).dump() == settings;
  } catch (const Json::exception&) {
    // Settings that are none: of no run.
  }
  if (!same) throw InputError(file + ": these are statistics of another run; remove the file");
  return result;
}

std::optional<Json> row_of_csv(const std::string& text) {
  std::istringstream lines(text);
  std::string header;
  std::string row;
  std::string more;
  if (!std::getline(lines, header) || !std::getline(lines, row) || std::getline(lines, more)) return std::nullopt;
  const std::vector<std::string> names = cells_of(header);
  const std::vector<std::string> values = cells_of(row);
  if (names.empty() || names.size() != values.size()) return std::nullopt;
  Json result = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i) result[names[i]] = value_of(values[i]);
  return result;
}

std::vector<std::string> words_for_result(const KeyedRun& run, const ResultFolder& folder, unsigned threads) {
  return words_for_result(run, folder, threads, folder.file(run.key));
}

std::vector<std::string> words_for_result(const KeyedRun& run, const ResultFolder& folder, unsigned threads,
                                          const std::filesystem::path& file) {
  std::vector<std::string> words = run.words;
  if (folder.from_output()) {
    words.insert(words.end(), {"--format", "csv"});
    return words;
  }
  std::vector<std::string> more = {"--threads", std::to_string(threads), "--quiet"};
  if (words.front() == "render") more.emplace_back("--no-picture");
  more.insert(more.end(), {"--stats", file.string()});
  words.insert(std::ranges::find(words, kEndOfOptions), more.begin(), more.end());
  return words;
}

}  // namespace torolux::study
