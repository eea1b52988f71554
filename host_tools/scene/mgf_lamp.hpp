// SPDX-License-Identifier: MIT
// MGF's ies (a measured lamp, IESNA LM-63) enters; what is told of it leaves.
#pragma once

#include <filesystem>

#include "host_tools/scene/files.hpp"
#include "host_tools/scene/mgf_statements.hpp"

namespace torolux {

/// Notes that the lamp is not rendered, and how many lumens are missing, where its file says so. folder: where the file
/// may lie.
void note_measured_lamp(const MgfStatement& statement, const std::filesystem::path& folder, SceneFiles& files,
                        Notices& notices);

}  // namespace torolux
