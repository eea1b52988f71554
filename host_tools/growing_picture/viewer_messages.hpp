// SPDX-License-Identifier: MIT
// Messages of the protocol by which renderers show pictures in tev (its IPC; HDRView and pbrt-v4 speak it, too): values
// enter, bytes leave. All is little endian; a message begins with its length in bytes, itself included (u32), and its
// kind (u8); strings end with a zero.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace torolux {

inline constexpr std::uint16_t kViewerPort = 14158;

enum class ViewerMessage : std::uint8_t { update_image = 3, create_image = 4 };

/// A part of a picture [pixels].
struct Rectangle {
  std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// A new picture, in place of one of that name. Kind, focus (u8: show it), name, width, height, number of channels (i32
/// each), their names.
std::vector<std::byte> create_image_message(const std::string& name, std::uint32_t width, std::uint32_t height,
                                            const std::vector<std::string>& channels);

/// New values of a part of one channel. Kind, focus, names of picture and channel, x, y, width, height (i32 each),
/// values (f32), by row. plane: the whole channel, `width` pixels to a row.
std::vector<std::byte> update_image_message(const std::string& name, const std::string& channel, const Rectangle& part,
                                            std::span<const float> plane, std::uint32_t width);

}  // namespace torolux
