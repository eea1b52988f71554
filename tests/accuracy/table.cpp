// SPDX-License-Identifier: MIT
// A row is printed as soon as it is added, so that a long run shows how far it is; files are written whole, and may be
// written again with more rows.
#include "tests/accuracy/table.hpp"

#include <array>
#include <cstdio>

#include "host_tools/files/write_file.hpp"

namespace torolux::accuracy {
namespace {

std::string line(const std::vector<std::string>& cells, const char* separator) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) text.append(i == 0 ? "" : separator).append(cells[i]);
  return text;
}

std::string markdown_line(const std::vector<std::string>& cells) {
  return "| " + line(cells, " | ") + " |\n";
}

}  // namespace

void Table::add(std::vector<std::string> row) {
  if (rows_.empty()) std::printf("%s\n", line(columns_, ", ").c_str());
  std::printf("%s\n", line(row, ", ").c_str());
  std::fflush(stdout);
  rows_.push_back(std::move(row));
}

void Table::write(const std::filesystem::path& stem) const {
  std::string csv = line(columns_, ",") + "\n";
  std::string markdown = markdown_line(columns_) + markdown_line(std::vector<std::string>(columns_.size(), "---"));
  for (const auto& row : rows_) {
    csv += line(row, ",") + "\n";
    markdown += markdown_line(row);
  }
  write_file(stem.string() + ".csv", csv);
  write_file(stem.string() + ".md", markdown);
}

std::string text_of(const char* format, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

}  // namespace torolux::accuracy
