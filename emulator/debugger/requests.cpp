// SPDX-License-Identifier: MIT
// Separators and hexadecimal numbers.
#include "emulator/debugger/requests.hpp"

#include "emulator/debugger/words.hpp"

namespace torolux::debugger {
namespace {

using Kind = ThreadChoice::Kind;

std::optional<ThreadChoice> by_number(std::string_view text) {
  if (text == "-1") return ThreadChoice{Kind::all};
  const auto number = number_in(text);
  if (!number) return std::nullopt;
  if (*number == 0) return ThreadChoice{Kind::any};
  return ThreadChoice{Kind::one, *number - 1};
}

std::optional<Resumption> resumption(std::string_view text) {
  using enum Resumption::Kind;
  if (text.empty()) return std::nullopt;
  const char action = text.front();
  text.remove_prefix(1);
  switch (action) {
    case 'c':
    case 'C':  // a signal: a PE has none
      return Resumption{goes_on};
    case 's':
    case 'S':
      return Resumption{steps};
    case 'r': {
      const auto begin = number_in(take_until(text, ','));
      const auto end = number_in(text);
      if (!begin || !end) return std::nullopt;
      return Resumption{in_range, *begin, *end};
    }
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<ThreadChoice> thread_choice(std::string_view text) {
  if (!text.starts_with('p')) return by_number(text);
  text.remove_prefix(1);
  const auto process = by_number(take_until(text, '.'));
  if (!process || text.empty()) return process;
  const auto thread = by_number(text);
  constexpr unsigned kOnlyThread = 0;  // number 1
  if (!thread || (thread->kind == Kind::one && thread->pe != kOnlyThread)) return std::nullopt;
  return process;
}

std::optional<unsigned> process_in(std::string_view text) {
  const auto number = number_in(text);
  return number && *number != 0 ? std::optional(*number - 1) : std::nullopt;
}

std::optional<std::vector<ResumeAction>> resume_actions(std::string_view text) {
  std::vector<ResumeAction> actions;
  if (!text.starts_with(';')) return std::nullopt;
  text.remove_prefix(1);
  while (!text.empty()) {
    std::string_view who = take_until(text, ';');
    const auto how = resumption(take_until(who, ':'));
    const auto choice = who.empty() ? ThreadChoice{Kind::all} : thread_choice(who);
    if (!how || !choice) return std::nullopt;
    actions.push_back({*how, *choice});
  }
  return actions.empty() ? std::nullopt : std::optional(std::move(actions));
}

std::optional<MemoryRange> memory_range(std::string_view text) {
  const auto address = number_in(take_until(text, ','));
  const auto bytes = number_in(text);
  if (!address || !bytes) return std::nullopt;
  return MemoryRange{*address, *bytes};
}

std::optional<Point> point_in(std::string_view text) {
  const std::string_view type = take_until(text, ',');
  // Conditions and commands behind a ';' are not offered.
  const auto range = memory_range(take_until(text, ';'));
  if (!range || type.size() != 1) return std::nullopt;
  switch (type.front()) {
    case '0':
    case '1':
      return Point{PointKind::breakpoint, range->address, 0};
    case '2':
      return Point{PointKind::write, range->address, range->bytes};
    case '3':
      return Point{PointKind::read, range->address, range->bytes};
    case '4':
      return Point{PointKind::access, range->address, range->bytes};
    default:
      return std::nullopt;
  }
}

}  // namespace torolux::debugger
