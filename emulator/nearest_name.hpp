// SPDX-License-Identifier: MIT
// A mistyped word and the names that there are enter; the name that was probably meant leaves, as a part of a message.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace torolux {

/// The one of `known` that is nearest to `word` by edit distance, letter case aside, or "" where none is near.
std::string nearest_name(std::string_view word, const std::vector<std::string>& known);

/// "; did you mean 'NEAREST'?", or "" where none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

/// "\"WORD\" is KIND; there are: A, B", with the nearest name before the list. kind: as in "no filter".
std::string no_such_name(std::string_view word, std::string_view kind, const std::vector<std::string>& known);

}  // namespace torolux
