// SPDX-License-Identifier: MIT
// Each pixel's light is added to the cell in which it lies, so that none is lost however small what shines is; pixels
// larger than cells are cut first.
#include "host_tools/scene/sky_image.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "emulator/errors.hpp"
#include "firmware/protocol/sky.hpp"
#include "host_tools/picture/formats.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

using protocol::kSkyBands;
using protocol::kSkyCells;
using protocol::kSkySectors;

/// Parts around the horizon and from pole to pole, at least: many to a cell, so that its mean does not show where
/// pixels begin.
constexpr std::uint32_t kLeastColumns = 16 * kSkySectors, kLeastRows = 16 * kSkyBands;

/// Into how many parts a pixel is cut.
std::uint32_t parts_of(std::uint32_t pixels, std::uint32_t least) {
  return (least + pixels - 1U) / pixels;
}

/// Of a place from left to right, 0..1.
std::uint32_t sector_at(double across) {
  const double azimuth = (across - 0.5) * 2 * std::numbers::pi;
  const float turn = protocol::sky_turn(static_cast<float>(std::sin(azimuth)), static_cast<float>(std::cos(azimuth)));
  return std::min(static_cast<std::uint32_t>(turn * (float{kSkySectors} / 4.0F)), kSkySectors - 1U);
}

std::uint32_t band_at(double height) {
  return std::min(static_cast<std::uint32_t>((height + 1) * (kSkyBands / 2)), kSkyBands - 1U);
}

Vec3d light_of(const std::array<float, 3>& pixel) {
  Vec3d light{};
  for (std::size_t c = 0; c < 3; ++c) light[c] = std::isfinite(pixel[c]) ? std::max(0.0, double{pixel[c]}) : 0;
  return light;
}

}  // namespace

std::vector<Vec3d> sky_image_table(const Picture& picture, const Vec3d& scale) {
  const std::uint32_t across = parts_of(picture.width, kLeastColumns);
  const std::uint32_t down = parts_of(picture.height, kLeastRows);
  const std::uint32_t columns = picture.width * across;
  const std::uint32_t rows = picture.height * down;
  std::vector<std::uint32_t> sector_of(columns);
  for (std::uint32_t x = 0; x < columns; ++x) sector_of[x] = sector_at((x + 0.5) / columns);

  std::vector<Vec3d> light(kSkyCells, Vec3d{0, 0, 0});
  std::vector<double> solid_angle(kSkyCells, 0);
  for (std::uint32_t y = 0; y < rows; ++y) {
    const double elevation = (0.5 - (y + 0.5) / rows) * std::numbers::pi;
    const std::size_t band = std::size_t{band_at(std::sin(elevation))} * kSkySectors;
    const double weight = std::cos(elevation);
    const auto row = std::span(picture.pixels).subspan(std::size_t{y / down} * picture.width, picture.width);
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::size_t cell = band + sector_of[x];
      light[cell] = vec::add(light[cell], vec::scale(light_of(row[x / across]), weight));
      solid_angle[cell] += weight;
    }
  }
  for (std::size_t cell = 0; cell < light.size(); ++cell)
    light[cell] = vec::scale(vec::times(light[cell], scale), 1 / solid_angle[cell]);
  return light;
}

std::vector<Vec3d> load_sky_image(const SkyImageEntry& entry, const std::filesystem::path& folder, SceneFiles& files) {
  const std::filesystem::path file = folder / entry.file;
  const std::string extension = file.extension().string();
  if (extension != ".exr" && extension != ".pfm")
    refuse(entry.place, "[sky] 'file' is '" + entry.file +
                            "': .exr and .pfm are read (oiiotool IN.hdr -o OUT.exr makes one of other formats)");
  const std::string text = files.read(file, entry.place, kMostMeshBytes);
  const auto bytes = std::as_bytes(std::span(text));
  const Picture picture = extension == ".exr" ? decode_exr(bytes, file.string()) : decode_pfm(bytes, file.string());
  std::vector<Vec3d> table = sky_image_table(picture, entry.scale);
  const auto shines = [](const Vec3d& radiance) { return vec::largest(radiance) > 0; };
  if (std::none_of(table.begin(), table.end(), shines))
    refuse(entry.place, "[sky] '" + entry.file + "' is black: there is no light in it");
  return table;
}

}  // namespace torolux
