// SPDX-License-Identifier: MIT
// Portable float map: a picture enters, the bytes of a .pfm leave, and the other way round.
// Format: P. Debevec, "HDRI and image-based lighting", https://www.pauldebevec.com/Research/HDR/PFM/
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "emulator/errors.hpp"
#include "host_tools/picture/formats.hpp"

namespace torolux {
namespace {

constexpr std::size_t kMostWord = 32;  ///< no word of a header is longer

struct Header {
  bool grey;
  std::uint64_t width, height;
  bool little_endian;
  float factor;
  std::size_t bytes;  ///< where the pixels begin
};

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// Takes the header apart word by word.
class HeaderReader {
 public:
  HeaderReader(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Header read() {
    Header header{};
    const std::string_view magic = word();
    if (magic != "PF" && magic != "Pf") refuse("does not begin with PF or Pf");
    header.grey = magic == "Pf";
    header.width = number(word());
    header.height = number(word());
    read_scale(header);
    header.bytes = position_;
    return header;
  }

  [[noreturn]] void refuse(const std::string& what) const { throw InputError(name_ + ": not a PFM picture: " + what); }

 private:
  /// The next word, and exactly one space after it.
  std::string_view word() {
    while (position_ < bytes_.size() && is_space(at(position_))) ++position_;
    const std::size_t begin = position_;
    while (position_ < bytes_.size() && !is_space(at(position_)) && position_ - begin <= kMostWord) ++position_;
    if (position_ == begin || position_ == bytes_.size() || position_ - begin > kMostWord)
      refuse("the header is damaged or cut off");
    const auto* text = reinterpret_cast<const char*>(bytes_.data()) + begin;
    return {text, position_++ - begin};
  }
  char at(std::size_t i) const { return static_cast<char>(bytes_[i]); }

  std::uint64_t number(std::string_view text) const {
    std::uint64_t value = 0;
    for (const char c : text) {
      if (c < '0' || c > '9' || value > kMostPicturePixels)
        refuse("\"" + std::string(text) + "\" is no width or height");
      value = 10 * value + static_cast<std::uint64_t>(c - '0');
    }
    return value;
  }

  void read_scale(Header& header) {
    const std::string text(word());
    char* end = nullptr;
    const float scale = std::strtof(text.c_str(), &end);
    if (*end != '\0' || !std::isfinite(scale) || scale == 0.0F) refuse("\"" + text + "\" is no scale");
    header.little_endian = scale < 0.0F;
    header.factor = std::fabs(scale);
  }

  std::span<const std::byte> bytes_;
  const std::string& name_;
  std::size_t position_ = 0;
};

void put_float(std::byte* to, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (unsigned i = 0; i < 4; ++i) to[i] = static_cast<std::byte>(bits >> (8U * i));
}

float get_float(const std::byte* from, bool little_endian) {
  std::uint32_t bits = 0;
  for (unsigned i = 0; i < 4; ++i)
    bits |= std::to_integer<std::uint32_t>(from[i]) << (8U * (little_endian ? i : 3U - i));
  return std::bit_cast<float>(bits);
}

}  // namespace

std::vector<std::byte> encode_pfm(const Picture& picture) {
  const std::string header = "PF\n" + std::to_string(picture.width) + " " + std::to_string(picture.height) + "\n-1.0\n";
  std::vector<std::byte> bytes(header.size() + picture.pixels.size() * 12);
  std::memcpy(bytes.data(), header.data(), header.size());
  std::byte* to = bytes.data() + header.size();
  for (std::size_t row = picture.height; row-- > 0;) {
    for (std::size_t column = 0; column < picture.width; ++column) {
      for (const float value : picture.pixels[row * picture.width + column]) {
        put_float(to, value);
        to += 4;
      }
    }
  }
  return bytes;
}

Picture decode_pfm(std::span<const std::byte> bytes, const std::string& name) {
  HeaderReader reader(bytes, name);
  const Header header = reader.read();
  check_picture_size(header.width, header.height, name);
  const std::size_t channels = header.grey ? 1 : 3;
  const std::uint64_t needed = header.width * header.height * channels * 4;
  if (bytes.size() - header.bytes != needed)
    reader.refuse("after the header " + std::to_string(needed) + " bytes should follow, not " +
                  std::to_string(bytes.size() - header.bytes));
  Picture picture{static_cast<std::uint32_t>(header.width), static_cast<std::uint32_t>(header.height), {}};
  picture.pixels.resize(header.width * header.height);
  const std::byte* from = bytes.data() + header.bytes;
  for (std::size_t row = picture.height; row-- > 0;) {
    for (std::size_t column = 0; column < picture.width; ++column) {
      auto& pixel = picture.pixels[row * picture.width + column];
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = header.factor * get_float(from + 4 * (header.grey ? 0 : c), header.little_endian);
      from += 4 * channels;
    }
  }
  return picture;
}

}  // namespace torolux
