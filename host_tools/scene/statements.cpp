// SPDX-License-Identifier: MIT
// Splits OBJ and MTL text into statements; reads numbers strictly.
#include "host_tools/scene/statements.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace torolux {
namespace {

constexpr std::string_view kBlank = " \t\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// A comment begins with a # at the beginning of a word: names such as `steel#2` stay whole.
std::string_view without_comment(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '#' && (i == 0 || kBlank.find(text[i - 1]) != std::string_view::npos)) return text.substr(0, i);
  return text;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string_view Statement::keyword() const {
  return std::string_view(text).substr(0, text.find_first_of(kBlank));
}

std::string_view Statement::rest() const {
  return trimmed(std::string_view(text).substr(keyword().size()));
}

std::vector<std::string_view> Statement::arguments() const {
  std::vector<std::string_view> words;
  std::string_view left = rest();
  while (!left.empty()) {
    const std::size_t end = std::min(left.find_first_of(kBlank), left.size());
    words.push_back(left.substr(0, end));
    left = trimmed(left.substr(end));
  }
  return words;
}

std::string_view StatementReader::next_line() {
  const std::size_t end = std::min(text_.find_first_of("\r\n"), text_.size());
  const std::string_view line = text_.substr(0, end);
  std::size_t skip = end;
  if (skip < text_.size()) skip += text_.substr(end, 2) == "\r\n" ? 2U : 1U;
  text_.remove_prefix(skip);
  ++line_;
  if (line.find('\0') != std::string_view::npos) refuse({file_, line_}, "a zero byte: this is not a text file");
  return line;
}

bool StatementReader::next(Statement& statement) {
  while (!text_.empty()) {
    std::string_view line = trimmed(without_comment(next_line()));
    statement.line = line_;
    statement.text.clear();
    while (!line.empty() && line.back() == '\\' && !text_.empty()) {
      statement.text.append(line.substr(0, line.size() - 1)).push_back(' ');
      line = trimmed(without_comment(next_line()));
    }
    statement.text.append(line);
    if (!trimmed(statement.text).empty()) {
      statement.text = std::string(trimmed(statement.text));
      return true;
    }
  }
  return false;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t most = 60;
  std::string text = "'";
  for (const char c : word.substr(0, most))
    text.push_back(static_cast<unsigned char>(c) < 0x20U || c == 0x7F ? '?' : c);
  if (word.size() > most) text += "...";
  return text + "'";
}

double read_number(std::string_view word, const Place& place) {
  std::string_view digits = word;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range)
    refuse(place, in_quotes(word) + " is beyond what a number can hold; use one between 1e-300 and 1e300");
  if (error != std::errc() || end != digits.data() + digits.size())
    refuse(place, in_quotes(word) + " is not a number; expected a decimal number such as -1.5 or 2e-3");
  if (!std::isfinite(value)) refuse(place, in_quotes(word) + " is not a finite number");
  return value;
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& known) {
  if (word.size() > 100) return {};
  std::string best;
  std::size_t best_distance = 1 + std::max<std::size_t>(2, word.size() / 3);
  for (const std::string& name : known) {
    if (name.size() > 100) continue;
    const std::size_t distance = edit_distance(word, name);
    if (distance < best_distance) {
      best_distance = distance;
      best = name;
    }
  }
  return best;
}

}  // namespace torolux
