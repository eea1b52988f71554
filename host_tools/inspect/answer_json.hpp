// SPDX-License-Identifier: MIT
// Answers enter; JSON leaves, for programs and the display's page. Units as in answers.hpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "host_tools/inspect/answers.hpp"

namespace torolux {

nlohmann::ordered_json answer_json(const ElementAnswer& answer);
nlohmann::ordered_json answer_json(const PeAnswer& answer);
nlohmann::ordered_json answer_json(const PixelAnswer& answer);

}  // namespace torolux
