// SPDX-License-Identifier: MIT
// Further layers of a picture: what each pixel shows besides its colour. Layers enter; channels of an .exr, or a .png
// each to look at, leave.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/protocol/niu_window.hpp"
#include "host_tools/picture/picture.hpp"

namespace torolux {

/// Bits of planes (protocol::plane_bit), never that of the colours.
using LayerSet = std::uint32_t;

struct LayerName {
  std::string_view name;
  protocol::Plane plane;
};
inline constexpr std::array<LayerName, 6> kLayerNames{{{"elements", protocol::Plane::elements},
                                                       {"irradiance", protocol::Plane::irradiance},
                                                       {"depth", protocol::Plane::depth},
                                                       {"normals", protocol::Plane::normals},
                                                       {"owner", protocol::Plane::owner},
                                                       {"cost", protocol::Plane::cost}}};
std::string_view name_of(protocol::Plane layer);
/// In the order of kLayerNames.
std::vector<LayerName> layers_in(LayerSet set);

/// In `numbers`: there is none.
inline constexpr std::uint32_t kNoNumber = 0xFFFF'FFFFU;

/// One layer of a picture, by pixel, row 0 on top.
struct Layer {
  protocol::Plane plane;
  /// irradiance: R G B [W/m^2]; depth: its first value [scene units], infinite where nothing is; normals: x y z, length
  /// 1, or 0 where nothing is.
  std::vector<std::array<float, 3>> values;
  /// elements, owner: a number, or kNoNumber; cost: subspaces.
  std::vector<std::uint32_t> numbers;
};

struct LayerChannel {
  std::string name;  ///< in an .exr
  std::size_t component = 0;
};
std::vector<LayerChannel> channels_of(const Layer& layer);

/// To look at, R G B bytes: irradiance as a picture is; depth bright where near; normals as (n + 1) / 2; elements and
/// owners each in a colour of its own; cost from black by red to white for the dearest pixel, by
/// its square root.
std::vector<std::uint8_t> show_layer(const Layer& layer, std::uint32_t width, std::uint32_t height,
                                     const ToneMapping& mapping);

/// As write_picture. An .exr holds the layers as channels; beside a .png stands another one for each (layer_file); a
/// .pfm holds the colours alone.
void write_layers(const Picture& picture, std::span<const Layer> layers, const std::filesystem::path& file,
                  const ToneMapping& mapping);
/// picture.png -> picture_depth.png
std::filesystem::path layer_file(const std::filesystem::path& file, std::string_view layer);
/// As check_writable, for all that write_layers would write.
void check_layers_writable(const std::filesystem::path& file, LayerSet set);

}  // namespace torolux
