// SPDX-License-Identifier: MIT
// Edit distance (Levenshtein 1966), and the wording of a suggestion.
#include "emulator/nearest_name.hpp"

#include <algorithm>
#include <numeric>

#include "emulator/printable.hpp"

namespace torolux {
namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0U : 1U)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

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

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  const std::string near = nearest_name(word, known);
  return near.empty() ? "" : "; did you mean '" + printable(near) + "'?";
}

std::string no_such_name(std::string_view word, std::string_view kind, const std::vector<std::string>& known) {
  const std::string near = did_you_mean(word, known);
  std::string text =
      "\"" + std::string(word) + "\" is " + std::string(kind) + near + (near.empty() ? "; there are:" : " There are:");
  for (const std::string& name : known) text += (&name == known.data() ? " " : ", ") + name;
  return text;
}

}  // namespace torolux
