// SPDX-License-Identifier: MIT
// A picture of linear radiance, and its files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace torolux {

struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::array<float, 3>> pixels;  ///< row 0 on top; linear radiance [W/(m^2 sr)]
};

enum class ToneCurve : std::uint8_t {
  filmic,
  linear,  ///< no curve: what is brighter than display white is cut off. For values that are to be compared
};

/// The light whose colour is to look white (white_balance.hpp).
struct WhiteBalance {
  enum class Kind : std::uint8_t {
    off,        ///< colours stay as they are
    automatic,  ///< guessed from the picture
    kelvin,     ///< a black body of this temperature
  };
  Kind kind = Kind::off;
  double kelvin = 0;

  bool operator==(const WhiteBalance&) const = default;
};
inline constexpr double kLeastWhiteKelvin = 1000, kMostWhiteKelvin = 40000;

/// From radiance to what a display shows (tone_map.hpp).
struct ToneMapping {
  double exposure_ev = 0;
  ToneCurve curve = ToneCurve::filmic;
  WhiteBalance white{};
};

/// Pictures beyond these are refused, read or written.
inline constexpr std::uint32_t kMostPictureEdge = 32768;
inline constexpr std::uint64_t kMostPicturePixels = std::uint64_t{1} << 27U;

/// By extension: .png (exposed, tone-mapped, sRGB, 8 bits; see tone_map.hpp), .exr, .pfm (linear radiance).
/// Written to a temporary file beside it and renamed. Throws InputError where it cannot be written.
void write_picture(const Picture& picture, const std::filesystem::path& file, const ToneMapping& mapping = {});

/// By extension: .exr or .pfm, which hold linear radiance.
bool holds_radiance(const std::filesystem::path& file);

/// Throws UsageError for an extension that write_picture does not know, InputError where nothing can be written there.
/// For calling before hours of work.
void check_writable(const std::filesystem::path& file);

/// .pfm or .exr. Throws InputError.
Picture read_picture(const std::filesystem::path& file);

}  // namespace torolux
