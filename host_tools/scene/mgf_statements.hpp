// SPDX-License-Identifier: MIT
// The text of an MGF file enters; its statements, words with their line, leave.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host_tools/scene/notices.hpp"

namespace torolux {

/// One entity of MGF with its arguments, and where it stands. The file's text and name outlive it.
class MgfStatement {
 public:
  MgfStatement(const std::string& file, std::size_t line, std::span<const std::string_view> words)
      : file_(file), line_(line), words_(words) {}

  Place place() const { return {file_, line_}; }
  const std::string& file() const { return file_; }
  std::size_t line() const { return line_; }
  std::string_view keyword() const { return words_[0]; }
  std::span<const std::string_view> arguments() const { return words_.subspan(1); }
  std::size_t count() const { return words_.size() - 1; }
  /// i: from 0, of the arguments.
  std::string_view word(std::size_t i) const { return words_[i + 1]; }
  /// Throws InputError: not a finite number.
  double number(std::size_t i) const;
  /// Throws InputError unless there are `least` to `most` arguments. form: as in "rd REFLECTANCE".
  void expect(std::size_t least, std::size_t most, const char* form) const;
  [[noreturn]] void refuse_with(const std::string& message) const { refuse(place(), message); }

 private:
  const std::string& file_;
  std::size_t line_;
  std::span<const std::string_view> words_;
};

/// A file's statements; empty lines and comments are left out.
class MgfText {
 public:
  /// A backslash at the end of a line, of a comment too, joins the next. What follows a # behind a statement is a
  /// comment as well, which is told. Throws InputError for a zero byte: not text.
  MgfText(std::string text, std::string file, Notices& notices);
  MgfText(const MgfText&) = delete;
  MgfText& operator=(const MgfText&) = delete;

  std::size_t size() const { return lines_.size(); }
  MgfStatement statement(std::size_t i) const;
  const std::string& file() const { return file_; }

 private:
  void add_line(std::string_view line, std::size_t number, Notices& notices);

  struct Line {
    std::size_t number;
    std::size_t first_word, words;
  };
  std::string text_, file_;
  std::vector<std::string_view> words_;
  std::vector<Line> lines_;
};

}  // namespace torolux
