// SPDX-License-Identifier: MIT
// Figures enter; the statistics leave as tables: one row for each thing counted, one column for each figure
// (docs/statistics.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "emulator/machine/machine.hpp"
#include "host_tools/render/render.hpp"

namespace torolux {

struct CsvTable {
  std::string name;    ///< of the file, without .csv
  std::string header;  ///< names in snake_case, with commas between them
  std::vector<std::string> rows;

  std::string text() const;  ///< header and rows, each line ended
};

std::vector<CsvTable> stats_tables(const MachineFigures& machine);
/// With what only a render has: rounds, visits.
std::vector<CsvTable> stats_tables(const RenderFigures& figures);

/// Makes the folder where it is not there, and checks that files can be written into it. Throws InputError.
void check_stats_folder(const std::filesystem::path& folder);
/// One file for each table, each written whole or not at all. Throws InputError.
void write_stats_tables(const std::filesystem::path& folder, const std::vector<CsvTable>& tables);

}  // namespace torolux
