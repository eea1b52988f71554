// SPDX-License-Identifier: MIT
// A run's statistics, and its picture if it has one, enter; one HTML file that needs nothing else leaves
// (docs/report.md).
#pragma once

#include <string>
#include <string_view>

#include "emulator/machine/machine.hpp"
#include "host_tools/picture/picture.hpp"

namespace torolux {

/// Pictures are shown no longer than this at any edge [pixels].
inline constexpr std::uint32_t kReportPictureEdge = 512;

struct ReportInput {
  std::string title;                 ///< scene or image, UTF-8
  std::string_view statistics;       ///< the JSON object that --stats writes
  const MachineFigures& machine;     ///< for what is not in the statistics: each stage's links
  const Picture* picture = nullptr;  ///< linear radiance; none: of `torolux run`
  ToneMapping tone;
  std::string_view profile = {};  ///< of flame_graph_json; empty: none
};

/// Each array of objects in the data that all have the same keys is written as an object of columns, {"$rows": n,
/// "$columns": {key: [...]}}, and so are those within; `<` as \u003c, so that nothing in it ends the script.
std::string report_html(const ReportInput& input);

/// Before the run. Throws InputError: the file cannot be written; UsageError: it has the extension of another format.
void check_report_writable(const std::filesystem::path& file);

}  // namespace torolux
