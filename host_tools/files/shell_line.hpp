// SPDX-License-Identifier: MIT
// Words of a command enter, a line for a shell leaves.
#pragma once

#include <string>
#include <vector>

namespace torolux {

/// Words for a shell, quoted where it needs that.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace torolux
