// SPDX-License-Identifier: MIT
// A command enters; the options that a plan may give to it leave. A plan's options enter; the command line that they
// make leaves.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "host_tools/study/plan.hpp"

namespace torolux::study {

/// How an option stands on a command line: alone, with a value, or either way.
enum class Takes : std::uint8_t { nothing, a_value, either };

/// By name a command's options that a plan may set; machine's parameters are named machine.KEY.
/// Throws InputError for a command that is not there or cannot be studied; place: where it is named.
std::map<std::string, Takes> options_of(const std::string& command, const Place& place);

/// What follows belongs to the program on the PEs.
inline constexpr const char* kEndOfOptions = "--";

/// The words after `torolux`: the command, its scene or image, options, and behind kEndOfOptions the program's
/// arguments. Paths are relative to the plan's folder.
std::vector<std::string> words_of(const Plan& plan, std::span<const PlanOption> options);

}  // namespace torolux::study
