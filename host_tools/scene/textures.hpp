// SPDX-License-Identifier: MIT
// Textures of a scene: map_Kd statements and files in, images out, each read once.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "host_tools/scene/cut_out.hpp"
#include "host_tools/scene/find_file.hpp"
#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/missing_materials.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {

/// Texture points of a face are moved to begin at 0 to 1, and may go on for this.
inline constexpr double kMostRepeats = 1e6;

/// The arguments of map_Kd, into `use`; no names where there is no file. Returns what in them would change the picture
/// in a way that is not provided for, or "".
std::string read_texture_use(const Statement& statement, const Place& place, Notices& notices, TextureUse& use);

/// Linear share of an sRGB value (IEC 61966-2-1), 0..1.
double linear_of_srgb(std::uint8_t value);

class TextureLibrary {
 public:
  TextureLibrary(SceneFiles& files, MissingMaterials missing, Notices& notices)
      : files_(files), missing_(missing), notices_(notices) {}

  /// The number of the image; kNoImage: nowhere, and white stands for it. Throws InputError: nowhere, not an image.
  std::uint32_t load(const TextureUse& use);
  /// What an image's alpha leaves of its faces; absent: all.
  const std::optional<CutOutMask>& mask(std::uint32_t texture) const { return masks_.at(texture); }
  /// The mask that an image of opacity (map_d) is: its alpha, or where it has none, its brightness. Absent: nowhere,
  /// and white stands for it. Throws InputError as load does.
  std::optional<CutOutMask> load_mask(const TextureUse& use);
  /// The greatest of each channel, linear.
  Vec3d brightest(std::uint32_t texture) const;
  std::vector<SceneTexture> take() { return std::move(textures_); }

 private:
  /// Absent: nowhere, which has been told.
  std::optional<std::string> find(const TextureUse& use) const;

  SceneFiles& files_;
  MissingMaterials missing_;
  Notices& notices_;
  std::string read(const TextureUse& use, const std::string& file) const;

  /// By file, base, gain, cutoff, clamp.
  std::map<std::tuple<std::string, double, double, double, bool>, std::uint32_t> number_;
  std::vector<SceneTexture> textures_;
  std::vector<std::optional<CutOutMask>> masks_;  // of textures_
};

}  // namespace torolux
