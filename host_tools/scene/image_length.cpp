// SPDX-License-Identifier: MIT
// Goes through a TGA's packets, or reckons a BMP's rows, against the bytes that there are.
#include "host_tools/scene/image_length.hpp"

namespace torolux {
namespace {

/// Little-endian; 0 beyond the end.
std::uint64_t number(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;)
    value = (value << 8U) | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0U);
  return value;
}

}  // namespace

bool tga_is_whole(std::string_view bytes, std::uint64_t width, std::uint64_t height) {
  constexpr std::uint64_t run_lengths = 8;
  const std::uint64_t palette = number(bytes, 5, 2) * ((number(bytes, 7, 1) + 7) / 8);
  const std::uint64_t pixel = (number(bytes, 16, 1) + 7) / 8;
  std::uint64_t at = 18 + number(bytes, 0, 1) + (number(bytes, 1, 1) == 1 ? palette : 0);
  if ((number(bytes, 2, 1) & run_lengths) == 0) return at + width * height * pixel <= bytes.size();
  for (std::uint64_t done = 0; done < width * height;) {
    if (at >= bytes.size()) return false;
    const std::uint64_t head = number(bytes, static_cast<std::size_t>(at), 1);
    const std::uint64_t count = (head & 0x7FU) + 1;
    at += 1 + ((head & 0x80U) != 0 ? 1 : count) * pixel;
    done += count;
  }
  return at <= bytes.size();
}

bool tga_begins_right(std::string_view bytes) {
  constexpr std::uint64_t from_the_right = 0x10;
  return (number(bytes, 17, 1) & from_the_right) != 0;
}

bool tga_has_alpha(std::string_view bytes) {
  constexpr std::uint64_t alpha_bits = 0x0F;
  return (number(bytes, 17, 1) & alpha_bits) != 0;
}

bool bmp_is_whole(std::string_view bytes, std::uint64_t width, std::uint64_t height) {
  constexpr std::uint64_t old_header = 12;
  const std::uint64_t bits = width * number(bytes, number(bytes, 14, 4) == old_header ? 24 : 28, 2);
  return number(bytes, 10, 4) + (bits + 31) / 32 * 4 * (height - 1) + (bits + 7) / 8 <= bytes.size();
}

}  // namespace torolux
