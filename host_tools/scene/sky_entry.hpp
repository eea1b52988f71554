// SPDX-License-Identifier: MIT
// The table [sky] of scene.toml in; sky, sun and openings out.
#pragma once

#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/toml_table.hpp"

namespace torolux {

/// Throws InputError with file and line: a key that is not known, a value of the wrong kind or out of its range, a sky
/// without light.
Sky read_sky(TomlTable table);

}  // namespace torolux
