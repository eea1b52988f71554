// SPDX-License-Identifier: MIT
// Is a run what it was? Two blocks of settings, or two runs' statistics, enter; where they differ leaves.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace torolux {

/// A line for each input whose digest is another one, or that only one of the two has; in the order of `was`.
std::vector<std::string> changed_inputs(const nlohmann::ordered_json& was, const nlohmann::ordered_json& is);

/// A line for each version (program, commit, protocol, statistics) that differs.
std::vector<std::string> changed_versions(const nlohmann::ordered_json& was, const nlohmann::ordered_json& is);

/// A line for each setting that differs, is new or has gone; engine, versions, inputs and names left out.
std::vector<std::string> changed_settings(const nlohmann::ordered_json& was, const nlohmann::ordered_json& is);

/// "KEY: was, is" for each figure of `was` that differs in `is`, in the order of `was`. Settings and what depends on
/// the computer or the engine are left out.
std::vector<std::string> changed_figures(const nlohmann::ordered_json& was, const nlohmann::ordered_json& is);

}  // namespace torolux
