// SPDX-License-Identifier: MIT
// Rows of text in; a CSV file, a Markdown file and lines on standard output out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace torolux::accuracy {

class Table {
 public:
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /// Prints the row at once. As many cells as columns, without commas.
  void add(std::vector<std::string> row);
  /// STEM.csv and STEM.md. Throws InputError where they cannot be written.
  void write(const std::filesystem::path& stem) const;
  std::size_t rows() const { return rows_.size(); }

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// printf's format of one double.
std::string text_of(const char* format, double value);

}  // namespace torolux::accuracy
