// SPDX-License-Identifier: MIT
// OBJ and MTL text in, statements out: words with their line; strict numbers.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host_tools/scene/files.hpp"

namespace torolux {

/// One statement: a line, or several joined by a backslash at their ends, without comment and outer white space. A
/// comment begins a line, or follows a blank in a statement of numbers: names may hold a #.
struct Statement {
  std::size_t line;  ///< of its beginning, from 1
  std::string text;

  std::string_view keyword() const;
  std::string_view rest() const;  ///< what follows the keyword, trimmed: a name may hold spaces
  std::vector<std::string_view> arguments() const;
};

/// Hands out one statement after the other; empty ones are left out. Throws InputError for a zero byte (not text); byte
/// order marks at the beginnings of lines (files joined to one) are passed over.
class StatementReader {
 public:
  StatementReader(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}
  bool next(Statement& statement);

 private:
  std::string_view next_line();

  std::string_view text_;
  std::string file_;
  std::size_t line_ = 0;
};

/// A number, or why there is none.
struct ReadNumber {
  double value = 0;
  std::string fault;  ///< empty: none
};
/// A finite decimal number, nothing around it.
ReadNumber parse_number(std::string_view word);
/// The same. Throws InputError naming the word.
double read_number(std::string_view word, const Place& place);

/// Letters of ASCII alone.
bool equal_but_for_case(std::string_view a, std::string_view b);

/// The one of `known` that `word` is, or is but for letter case; "" where there is none.
std::string_view keyword_among(std::string_view word, std::span<const std::string_view> known);

/// A word as it may stand in a message: cut to a bearable length, without control characters.
std::string in_quotes(std::string_view word);

}  // namespace torolux
