// SPDX-License-Identifier: MIT
// All results of a study enter; one table leaves: a row for each point, in the plan's order.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "host_tools/study/points.hpp"
#include "host_tools/study/results.hpp"

namespace torolux::study {

struct Table {
  std::vector<std::string> columns;
  std::size_t varied = 0;               ///< the first so many columns say which run it is
  std::vector<std::vector<Json>> rows;  ///< null: no such value
  std::vector<bool> there;              ///< by row: the run has its result

  /// Position of a column, or columns.size().
  std::size_t column(const std::string& name) const;
};

/// points and keys run alike; results: by key. y: figures of the report that come first, then the standard ones (of a
/// command without statistics: all that its runs tell).
Table make_table(const Plan& plan, const std::vector<Point>& points, const std::vector<std::string>& keys,
                 const std::map<std::string, Json>& results, const std::vector<std::string>& y);

/// Throws InputError where the plan names a baseline that none of its points can be compared with.
void check_baseline(const Plan& plan, const std::vector<Point>& points);

/// RFC 4180, with a line end after each row; numbers exact.
std::string csv_of(const Table& table);

/// For people: the varied columns, and the figures named, to four digits.
std::string markdown_of(const Table& table, const std::vector<std::string>& y);

}  // namespace torolux::study
