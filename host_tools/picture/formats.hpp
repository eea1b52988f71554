// SPDX-License-Identifier: MIT
// The picture formats, each between a Picture and the bytes of a file. `name` is for messages only.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "host_tools/picture/layers.hpp"
#include "host_tools/picture/picture.hpp"
#include "host_tools/picture/tone_map.hpp"

namespace torolux {

/// PFM, colour, 32-bit float, little endian (scale -1.0), bottom row first.
std::vector<std::byte> encode_pfm(const Picture& picture);
/// Colour (PF) or grey (Pf), either byte order; the size of the scale is a factor. Throws InputError.
Picture decode_pfm(std::span<const std::byte> bytes, const std::string& name);

/// OpenEXR, scan lines, 32-bit float R, G, B and the layers' channels (numbers as 32-bit unsigned), ZIP compression.
std::vector<std::byte> encode_exr(const Picture& picture, std::span<const Layer> layers = {});
/// One part with channels R, G, B or only Y, any pixel type; the data window is the picture. Throws InputError.
Picture decode_exr(std::span<const std::byte> bytes, const std::string& name);

/// PNG, 8 bits per channel, sRGB, through tone_map.
std::vector<std::byte> encode_png(const Picture& picture, const ToneMapping& mapping);
/// bytes: R G B, row 0 on top.
std::vector<std::byte> encode_png(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> bytes);

/// Throws InputError where a picture of this size would be beyond the limits of picture.hpp, or empty.
void check_picture_size(std::uint64_t width, std::uint64_t height, const std::string& name);

}  // namespace torolux
