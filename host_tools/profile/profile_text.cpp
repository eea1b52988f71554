// SPDX-License-Identifier: MIT
// Columns of numbers, to the right; names last, since they may be long.
#include "host_tools/profile/profile_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

std::string share_text(std::uint64_t part, std::uint64_t whole) {
  return fixed(100 * share(part, whole), 2);
}

constexpr std::array<const char*, 9> kColumns = {"self %", "self", "waits %", "total %", "calls",
                                                 "least",  "mean", "most",    "function"};
using Row = std::array<std::string, kColumns.size()>;

Row row_of(const FunctionTotals& function, const ProfileTotals& totals, const ProfileNames& names) {
  const Spread& spread = function.spread;
  const bool waits = is_wait(function.name);
  return {share_text(function.self, totals.cycles),
          grouped(function.self),
          waits ? "" : share_text(function.waits, totals.cycles),
          share_text(function.total, totals.cycles),
          waits ? "" : grouped(function.calls),
          grouped(spread.least),
          grouped(static_cast<std::uint64_t>(std::llround(spread.mean))),
          grouped(spread.most),
          names.all()[function.name]};
}

std::string line_of(const Row& row, const Row& widths) {
  std::string line;
  for (std::size_t i = 0; i + 1 < row.size(); ++i) line += right(row[i], widths[i].size()) + "  ";
  return line + row.back() + "\n";
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += c;
    result += c;
  }
  return result + "\"";
}

}  // namespace

std::string profile_table(const ProfileTotals& totals, const ProfileNames& names, std::size_t pes, std::size_t most) {
  std::string text = grouped(totals.cycles) + " cycles of " + grouped(pes) + (pes == 1 ? " PE" : " PEs") +
                     " until each had ended: " + percent(share(totals.cycles - totals.waits, totals.cycles)) +
                     " busy, " + percent(share(totals.waits, totals.cycles)) +
                     " waiting. Least, mean and most: self of a PE.\n\n";
  Row widths;
  std::vector<Row> rows(1);
  std::copy(kColumns.begin(), kColumns.end(), rows.front().begin());
  const std::size_t shown = std::min(most, totals.functions.size());
  for (std::size_t i = 0; i < shown; ++i) rows.push_back(row_of(totals.functions[i], totals, names));
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i].resize(std::max(widths[i].size(), row[i].size()));
  }
  for (const Row& row : rows) text += line_of(row, widths);
  const std::size_t left_out = totals.functions.size() - shown;
  if (left_out != 0) text += "... and " + grouped(left_out) + " more (--most)\n";
  return text;
}

std::string profile_csv(const ProfileTotals& totals, const ProfileNames& names) {
  std::string text =
      "function,calls,self_cycles,wait_cycles,total_cycles,least_self_cycles,least_pe,mean_self_cycles,"
      "most_self_cycles,most_pe\n";
  for (const FunctionTotals& function : totals.functions) {
    const Spread& spread = function.spread;
    text += quoted(names.all()[function.name]) + "," + std::to_string(function.calls) + "," +
            std::to_string(function.self) + "," + std::to_string(function.waits) + "," +
            std::to_string(function.total) + "," + std::to_string(spread.least) + "," +
            std::to_string(spread.least_pe) + "," + significant(spread.mean, 12) + "," + std::to_string(spread.most) +
            "," + std::to_string(spread.most_pe) + "\n";
  }
  return text;
}

std::string folded_paths(const PathTree& tree, const ProfileNames& names) {
  std::vector<std::size_t> length_of(tree.paths.size());  // of the part of `stack` that ends with this path
  std::string stack, text;
  for (std::size_t i = 1; i < tree.paths.size(); ++i) {
    const Path& path = tree.paths[i];
    std::string name = names.all()[path.name];
    std::replace(name.begin(), name.end(), ';', ':');  // what separates frames
    stack.resize(length_of[path.parent]);
    stack += (path.parent == 0 ? "" : ";") + name;
    length_of[i] = stack.size();
    if (path.self != 0) text += stack + " " + std::to_string(path.self) + "\n";
  }
  return text;
}

}  // namespace torolux
