// SPDX-License-Identifier: MIT
// Textures as the machine holds them: an image in; fewer texels, and means over triangles, out.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/protocol/texture.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

struct MachineTexture {
  std::uint32_t width = 0, height = 0;
  std::vector<protocol::Texel> texels;  ///< row by row from the lowest
  /// Texels all around that repeat the outermost ones: of an image that does not repeat, as it would be looked up
  /// bilinearly into its opposite edge otherwise.
  std::uint32_t border = 0;

  /// Where a point of the image lies in this texture.
  protocol::TexturePoint placed(protocol::TexturePoint point) const;
};

/// Without its border at most `most_texels` (>= 1) and edges of at most protocol::kMostTextureEdge with it, in the
/// image's shape; each texel the mean, in linear light, of the area that it stands for.
MachineTexture machine_texture(const SceneTexture& image, std::uint32_t most_texels);

/// Colours 0..1, linear; row by row from the lowest.
struct LinearImage {
  std::uint32_t width, height;
  std::vector<Vec3d> colours;
};

/// Of one texture: means over triangles, as looked up bilinearly.
class TextureMeans {
 public:
  explicit TextureMeans(const MachineTexture& texture);

  /// Over the triangle with these corners.
  Vec3d over(const std::array<protocol::TexturePoint, 3>& corner) const;

 private:
  std::vector<LinearImage> levels_;  // each half as wide and high as the one before, down to one texel
};

}  // namespace torolux
