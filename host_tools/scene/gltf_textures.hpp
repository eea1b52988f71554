// SPDX-License-Identifier: MIT
// References of glTF materials to textures in; how texture points are moved, images to be loaded, and mean values, out.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "host_tools/scene/gltf_data.hpp"
#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

/// From a primitive's texture points (v downwards) to ours (v upwards), by KHR_texture_transform.
struct GltfMapping {
  std::string attribute;  ///< "TEXCOORD_0"; none: no texture
  std::array<double, 2> offset{0, 0}, scale{1, 1};
  double rotation = 0;    ///< radians, counter-clockwise
  bool odd_wrap = false;  ///< beyond its edges it is mirrored, or goes on in one direction alone: here it repeats

  std::array<double, 2> placed(double u, double v) const;
};

/// Over all texels, 0..1.
struct MeanTexel {
  Vec3d linear{1, 1, 1};  ///< colours, their sRGB turned into linear light
  Vec3d raw{1, 1, 1};     ///< values as they stand
};

class GltfTextures {
 public:
  /// data must outlive it.
  GltfTextures(const GltfObject& root, GltfData& data, SceneFiles& files, Notices& notices)
      : root_(root), data_(data), files_(files), notices_(notices) {}

  /// info: a textureInfo of a material. No names: its image is in a form that is not read, which is told.
  TextureUse use(const GltfObject& info, const Place& place, GltfMapping& mapping);
  /// Absent: the image is nowhere, or in a form that is not read; told.
  std::optional<MeanTexel> mean(const GltfObject& info, const Place& place);

 private:
  std::optional<std::size_t> image_of(const GltfObject& info, const Place& place);

  GltfObject root_;
  GltfData& data_;
  SceneFiles& files_;
  Notices& notices_;
  std::map<std::size_t, std::optional<MeanTexel>> means_;  // by image
};

}  // namespace torolux
