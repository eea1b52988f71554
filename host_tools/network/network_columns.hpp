// SPDX-License-Identifier: MIT
// The columns of what `torolux network` prints.
#pragma once

#include <string>
#include <vector>

namespace torolux {

std::vector<std::string> network_columns();

}  // namespace torolux
