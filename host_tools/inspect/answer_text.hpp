// SPDX-License-Identifier: MIT
// Answers enter; lines that a person reads leave.
#pragma once

#include <string>

#include "host_tools/inspect/answers.hpp"

namespace torolux {

std::string answer_text(const ElementAnswer& answer);
std::string answer_text(const PeAnswer& answer);
std::string answer_text(const PixelAnswer& answer);

}  // namespace torolux
