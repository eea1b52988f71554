// SPDX-License-Identifier: MIT
// Finds, reads and keeps the images that materials name.
#include "host_tools/scene/textures.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/scene/texture_image.hpp"

namespace torolux {

double linear_of_srgb(std::uint8_t value) {
  const double v = value / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::optional<FoundFile> TextureLibrary::find(const TextureUse& use) const {
  for (const std::string& name : use.names)
    if (const auto found = find_file(name, use.folders, files_, use.place))
      return FoundFile{found->path, found->as_written && name == use.names[0]};
  return std::nullopt;
}

std::uint32_t TextureLibrary::load(const TextureUse& use) {
  const auto found = find(use);
  if (!found) {
    if (missing_ == MissingMaterials::refuse)
      refuse(use.place, "there is no texture '" + (use.folders.at(0) / use.names[0]).lexically_normal().string() +
                            "'; put it there (names are relative to the material library), take the map_Kd line out, "
                            "give the material in scene.toml, or use --missing-materials white");
    notices_.note("there is no texture, white stands for it", use.place, in_quotes(use.names[0]));
    return kNoImage;
  }
  const std::string file = found->path.string();
  if (!found->as_written)
    notices_.note("a texture is found under another name", use.place,
                  in_quotes(use.names[0]) + " is " + in_quotes(file));
  const auto [entry, fresh] = number_.emplace(file, static_cast<std::uint32_t>(textures_.size()));
  if (!fresh) return entry->second;
  textures_.push_back(decode_texture(files_.read(file, use.place, kMostImageBytes), file, use.place, notices_));
  return entry->second;
}

Vec3d TextureLibrary::brightest(std::uint32_t texture) const {
  std::array<std::uint8_t, 3> most{};
  for (const auto& texel : textures_[texture].texels) {
    for (std::size_t c = 0; c < 3; ++c) most[c] = std::max(most[c], texel[c]);
  }
  return {linear_of_srgb(most[0]), linear_of_srgb(most[1]), linear_of_srgb(most[2])};
}

}  // namespace torolux
