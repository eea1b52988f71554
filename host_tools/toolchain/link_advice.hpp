// SPDX-License-Identifier: MIT
// What a linker said enters; what it means for an image, and what to do, leaves.
#pragma once

#include <string>
#include <vector>

namespace torolux {

/// Sentences on what typically goes wrong, each once, in a fixed order; none where nothing is known. errors: GCC's and
/// the linker's output, of any length.
std::vector<std::string> link_advice(const std::string& errors);

}  // namespace torolux
