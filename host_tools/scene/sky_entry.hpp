// SPDX-License-Identifier: MIT
// The table [sky] of scene.toml in; sky, sun and openings out.
#pragma once

#include <optional>

#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/sky_image.hpp"
#include "host_tools/scene/toml_table.hpp"

namespace torolux {

/// Throws InputError with file and line: a key that is not known, a value of the wrong kind or out of its range, a sky
/// without light. image: where the sky is a picture, which is still to be loaded into its table.
Sky read_sky(TomlTable table, std::optional<SkyImageEntry>& image);

}  // namespace torolux
