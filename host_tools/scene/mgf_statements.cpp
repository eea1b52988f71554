// SPDX-License-Identifier: MIT
// Splits MGF into statements.
#include "host_tools/scene/mgf_statements.hpp"

#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

constexpr std::string_view kBlank = " \t\v\f\r\n";

}  // namespace

double MgfStatement::number(std::size_t i) const {
  return read_number(word(i), place());
}

void MgfStatement::expect(std::size_t least, std::size_t most, const char* form) const {
  if (count() >= least && count() <= most) return;
  refuse_with("'" + std::string(keyword()) + "' has " + std::to_string(count()) + " arguments; it is written " + form);
}

MgfText::MgfText(std::string text, std::string file, Notices& notices)
    : text_(std::move(text)), file_(std::move(file)) {
  std::size_t number = 1;
  for (std::size_t at = 0; at < text_.size();) {
    std::size_t end = at;
    const std::size_t first_line = number;
    for (;; ++end) {
      end = text_.find_first_of("\n\r", end);
      if (end == std::string::npos) end = text_.size();
      if (end == text_.size()) break;
      ++number;
      const bool joined = end > at && text_[end - 1] == '\\';
      if (joined) text_[end - 1] = ' ';
      if (text_[end] == '\r' && end + 1 < text_.size() && text_[end + 1] == '\n') ++end;
      if (!joined) break;
    }
    add_line(std::string_view(text_).substr(at, end - at), first_line, notices);
    at = end + 1;
  }
}

void MgfText::add_line(std::string_view line, std::size_t number, Notices& notices) {
  if (line.find('\0') != std::string_view::npos) refuse({file_, number}, "a zero byte: this is not a text file");
  const std::size_t first_word = words_.size();
  for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;
       at = line.find_first_not_of(kBlank, at)) {
    const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
    if (line[at] == '#') {
      if (words_.size() > first_word) notices.note("a comment behind a statement is not used", {file_, number});
      break;
    }
    words_.push_back(line.substr(at, end - at));
    at = end;
  }
  if (words_.size() > first_word) lines_.push_back({number, first_word, words_.size() - first_word});
}

MgfStatement MgfText::statement(std::size_t i) const {
  const Line& line = lines_[i];
  return {file_, line.number, std::span(words_).subspan(line.first_word, line.words)};
}

}  // namespace torolux
