// SPDX-License-Identifier: MIT
// The profiles of PEs enter; a file for speedscope leaves (https://www.speedscope.app/file-format-schema.json): all of
// them together first, then each.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "host_tools/profile/paths.hpp"

namespace torolux {

/// name: of the image. take: gets the text, piece by piece. "sampled": a stack for each path that has cycles of its
/// own, with these as its weight; their unit is "none", for there are no cycles in the format.
void write_speedscope(const profile::CycleProfile& profile, const ProfileNames& names, std::span<const unsigned> pes,
                      const std::string& name, const std::function<void(std::string_view)>& take);

}  // namespace torolux
