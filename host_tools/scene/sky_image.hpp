// SPDX-License-Identifier: MIT
// An equirectangular picture of radiance in; the sky's table out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/picture/picture.hpp"
#include "host_tools/scene/files.hpp"
#include "host_tools/scene/notices.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Of [sky]: a picture in place of a model.
struct SkyImageEntry {
  std::string file;  ///< .exr or .pfm, relative to the scene.toml
  Vec3d scale{1, 1, 1};
  Place place;
};

/// By cell of the machine's table: the mean over the cell of what the picture has there, times `scale`. Its middle is
/// north, a quarter to the right is east, its top row is up. What is below 0, or no number, counts as 0,
/// what is infinite as 65504.
std::vector<Vec3d> sky_image_table(const Picture& picture, const Vec3d& scale);

/// folder: of the scene.toml. Notes pixels that do not say how bright they are. Throws InputError: a picture that
/// cannot be read, or one without light.
std::vector<Vec3d> load_sky_image(const SkyImageEntry& entry, const std::filesystem::path& folder, SceneFiles& files,
                                  Notices& notices);

}  // namespace torolux
