// SPDX-License-Identifier: MIT
// A TGA or BMP enters; what stb_image does not tell leaves: whether its pixels end before the file does (what is
// missing is black to it), and where a TGA's rows begin.
#pragma once

#include <cstdint>
#include <string_view>

namespace torolux {

/// Truevision TGA 2.0: header of 18 bytes, name, palette, pixels or packets of them. width, height: as read of it.
bool tga_is_whole(std::string_view bytes, std::uint64_t width, std::uint64_t height);

/// Its rows begin with the rightmost pixel, which stb_image takes for the leftmost.
bool tga_begins_right(std::string_view bytes);

/// Its header tells how many bits of a pixel are alpha; programs fill the rest of 32 with anything.
bool tga_has_alpha(std::string_view bytes);

/// A bitmap without compression: rows of whole words; the last one's filling may be left out.
bool bmp_is_whole(std::string_view bytes, std::uint64_t width, std::uint64_t height);

}  // namespace torolux
