// SPDX-License-Identifier: MIT
// The forms of --follow, told apart by their comma.
#include "host_tools/trace/follow_target.hpp"

#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

/// Of all of a text between separators; absent: one of them is no whole number of 32 bits.
std::optional<std::vector<std::uint32_t>> numbers(std::string_view text, char separator) {
  std::vector<std::uint32_t> all;
  while (true) {
    const std::size_t end = std::min(text.find(separator), text.size());
    std::uint32_t number = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + end, number);
    if (error != std::errc() || rest != text.data() + end || end == 0) return std::nullopt;
    all.push_back(number);
    if (end == text.size()) return all;
    text.remove_prefix(end + 1);
  }
}

}  // namespace

FollowTarget parse_follow(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma != std::string::npos) {
    const auto column = numbers(std::string_view(text).substr(0, comma), ':');
    const auto rest = numbers(std::string_view(text).substr(comma + 1), ':');
    if (column && rest && column->size() == 1 && rest->size() <= 2)
      return FollowedPixel{column->front(), rest->front(), rest->size() == 2 ? rest->back() : 0};
  } else if (const auto all = numbers(text, ':'); all && (all->size() == 2 || all->size() == 3)) {
    return FollowedShot{(*all)[0], (*all)[1], all->size() == 3 ? (*all)[2] : 0};
  }
  throw UsageError(
      "--follow: '" + text +
      "' is neither a pixel (X,Y or X,Y:SAMPLE) nor a point of a shot (SHOT:POINT or SHOT:POINT:DIRECTION), all "
      "counted from 0");
}

}  // namespace torolux
