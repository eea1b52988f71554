// SPDX-License-Identifier: MIT
// A list and a value enter; where in the list the value stands leaves.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace torolux {

/// The first that equals `value`, which is put behind the others where none does.
template <typename T>
std::uint32_t number_among(std::vector<T>& all, const T& value) {
  const auto same = std::ranges::find(all, value);
  const auto number = static_cast<std::uint32_t>(same - all.begin());
  if (same == all.end()) all.push_back(value);
  return number;
}

}  // namespace torolux
