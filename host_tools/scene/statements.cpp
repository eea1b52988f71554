// SPDX-License-Identifier: MIT
// Splits OBJ and MTL text into statements; reads numbers strictly.
#include "host_tools/scene/statements.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "emulator/printable.hpp"
#include "host_tools/scene/keep_on.hpp"

namespace torolux {
namespace {

constexpr std::string_view kBlank = " \t\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

constexpr std::array<std::string_view, 18> kNamed{"usemtl", "newmtl", "mtllib",    "g",          "o",    "usemap",
                                                  "maplib", "call",   "csh",       "shadow_obj", "bump", "norm",
                                                  "disp",   "decal",  "trace_obj", "refl",       "map",  "mg"};

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Does a name follow this keyword?
bool is_named(std::string_view keyword) {
  return equal_but_for_case(keyword.substr(0, 4), "map_") || !keyword_among(keyword, kNamed).empty();
}

std::string_view first_word(std::string_view text) {
  return text.substr(0, text.find_first_of(kBlank));
}

std::string_view without_comment(std::string_view text, bool named) {
  if (!text.empty() && text[0] == '#') return {};
  for (std::size_t i = 1; !named && i < text.size(); ++i)
    if (text[i] == '#' && kBlank.find(text[i - 1]) != std::string_view::npos) return text.substr(0, i);
  return text;
}

}  // namespace

std::string_view Statement::keyword() const {
  return first_word(text);
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
  std::string_view line = text_.substr(0, end);
  std::size_t skip = end;
  if (skip < text_.size()) skip += text_.substr(end, 2) == "\r\n" ? 2U : 1U;
  text_.remove_prefix(skip);
  look_for_interruption(++line_);
  if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  if (line.find('\0') != std::string_view::npos) refuse({file_, line_}, "a zero byte: this is not a text file");
  return line;
}

bool StatementReader::next(Statement& statement) {
  while (!text_.empty()) {
    std::string_view line = trimmed(next_line());
    const bool named = is_named(first_word(line));
    line = trimmed(without_comment(line, named));
    statement.line = line_;
    statement.text.clear();
    while (!line.empty() && line.back() == '\\' && !text_.empty()) {
      statement.text.append(line.substr(0, line.size() - 1)).push_back(' ');
      line = trimmed(without_comment(trimmed(next_line()), named));
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
  std::string text = "'" + printable(std::string(word.substr(0, most)));
  if (word.size() > most) text += "...";
  return text + "'";
}

ReadNumber parse_number(std::string_view word) {
  std::string_view digits = word;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  ReadNumber read;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), read.value);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size()) {
    read.fault = in_quotes(word) + " is not a number; expected a decimal number such as -1.5 or 2e-3";
  } else if (error == std::errc::result_out_of_range) {
    // Too small is zero, or nearly; too large is infinite.
    read.value = std::strtod(std::string(digits).c_str(), nullptr);
    if (!std::isfinite(read.value))
      read.fault = in_quotes(word) + " is beyond what a number can hold; use one between 1e-300 and 1e300";
  } else if (!std::isfinite(read.value)) {
    read.fault = in_quotes(word) + " is not a finite number";
  }
  return read;
}

double read_number(std::string_view word, const Place& place) {
  const ReadNumber read = parse_number(word);
  if (!read.fault.empty()) refuse(place, read.fault);
  return read.value;
}

bool equal_but_for_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return lower(x) == lower(y); });
}

std::string_view keyword_among(std::string_view word, std::span<const std::string_view> known) {
  if (const auto found = std::ranges::find(known, word); found != known.end()) return *found;
  const auto alike =
      std::ranges::find_if(known, [word](std::string_view other) { return equal_but_for_case(word, other); });
  return alike == known.end() ? std::string_view() : *alike;
}

}  // namespace torolux
