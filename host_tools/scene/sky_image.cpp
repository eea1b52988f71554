// SPDX-License-Identifier: MIT
// Each pixel's light is shared out to the cells that it covers, by their common solid angle: height by turn, exactly
// (Lambert's cylinder). So none is lost however small what shines is.
#include "host_tools/scene/sky_image.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "emulator/errors.hpp"
#include "firmware/protocol/sky.hpp"
#include "host_tools/picture/formats.hpp"
#include "host_tools/scene/sky.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

using protocol::kSkyBands;
using protocol::kSkyCells;
using protocol::kSkySectors;

/// A band or a sector, and how much of it a row or a column of pixels covers [height, radian].
struct Share {
  std::size_t part;
  double size;
};

void add_overlap(std::size_t part, double begin, double end, double from, double to, std::vector<Share>& shares) {
  const double size = std::min(end, to) - std::max(begin, from);
  if (size > 0) shares.push_back({part, size});
}

/// begin, end: heights, -1..1.
std::vector<Share> bands_of(double begin, double end) {
  std::vector<Share> shares;
  for (std::size_t band = 0; band < kSkyBands; ++band) {
    const auto border = [](std::size_t i) { return static_cast<double>(i) * (2.0 / kSkyBands) - 1; };
    add_overlap(band, begin, end, border(band), border(band + 1), shares);
  }
  return shares;
}

/// begin, end: angles from east to north, -pi/2 to 3/2 pi.
std::vector<Share> sectors_of(double begin, double end) {
  std::vector<Share> shares;
  for (std::size_t sector = 0; sector < kSkySectors; ++sector) {
    for (const double round : {0.0, 2 * std::numbers::pi})
      add_overlap(sector, begin + round, end + round, sky_sector_begin(sector), sky_sector_begin(sector + 1), shares);
  }
  return shares;
}

/// The largest of the half floats in which skies are kept: what was brighter is infinite in them.
constexpr double kMostHalf = 65504;

Vec3d light_of(const std::array<float, 3>& pixel) {
  Vec3d light{};
  for (std::size_t c = 0; c < 3; ++c) {
    if (pixel[c] > 0) light[c] = std::isinf(pixel[c]) ? kMostHalf : double{pixel[c]};
  }
  return light;
}

/// Of pixels that do not say how bright they are.
void note_odd_pixels(const Picture& picture, const SkyImageEntry& entry, Notices& notices) {
  std::size_t infinite = 0;
  std::size_t none = 0;
  for (const auto& pixel : picture.pixels) {
    const auto any = [&pixel](const auto& is) { return std::any_of(pixel.begin(), pixel.end(), is); };
    if (any([](float value) { return !(value >= 0); }))
      ++none;
    else if (any([](float value) { return std::isinf(value); }))
      ++infinite;
  }
  const auto note = [&](std::size_t count, const std::string& what) {
    if (count != 0)
      notices.note("[sky] '" + entry.file + "' has " + std::to_string(count) + " pixels " + what, entry.place);
  };
  note(infinite,
       "that are infinite; counted as 65504, the most that a half float holds (a sun that was cut off: give it by "
       "[sky.sun])");
  note(none, "below 0 or no number; their channels count as 0");
}

}  // namespace

std::vector<Vec3d> sky_image_table(const Picture& picture, const Vec3d& scale) {
  std::vector<std::vector<Share>> sectors;
  for (std::uint32_t x = 0; x < picture.width; ++x) {
    const auto angle = [&](double at) { return (1.5 - 2 * at / picture.width) * std::numbers::pi; };
    sectors.push_back(sectors_of(angle(x + 1.0), angle(x)));
  }
  std::vector<Vec3d> table(kSkyCells, Vec3d{0, 0, 0});
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    const auto height = [&](double at) { return std::sin((0.5 - at / picture.height) * std::numbers::pi); };
    const std::vector<Share> bands = bands_of(height(y + 1.0), height(y));
    const auto row = std::span(picture.pixels).subspan(std::size_t{y} * picture.width, picture.width);
    for (std::uint32_t x = 0; x < picture.width; ++x) {
      const Vec3d light = vec::times(light_of(row[x]), scale);
      for (const Share& band : bands) {
        for (const Share& sector : sectors[x]) {
          Vec3d& cell = table[band.part * kSkySectors + sector.part];
          cell = vec::add(cell, vec::scale(light, band.size * sector.size));
        }
      }
    }
  }
  for (std::size_t cell = 0; cell < table.size(); ++cell)
    table[cell] = vec::scale(table[cell], 1 / sky_cell_solid_angle(cell));
  return table;
}

std::vector<Vec3d> load_sky_image(const SkyImageEntry& entry, const std::filesystem::path& folder, SceneFiles& files,
                                  Notices& notices) {
  const std::filesystem::path file = folder / entry.file;
  const std::string extension = file.extension().string();
  if (extension != ".exr" && extension != ".pfm")
    refuse(entry.place, "[sky] 'file' is '" + entry.file +
                            "': .exr and .pfm are read (oiiotool IN.hdr -o OUT.exr makes one of other formats)");
  const std::string text = files.read(file, entry.place, kMostMeshBytes);
  const auto bytes = std::as_bytes(std::span(text));
  const Picture picture = extension == ".exr" ? decode_exr(bytes, file.string()) : decode_pfm(bytes, file.string());
  note_odd_pixels(picture, entry, notices);
  std::vector<Vec3d> table = sky_image_table(picture, entry.scale);
  const auto shines = [](const Vec3d& radiance) { return vec::largest(radiance) > 0; };
  if (std::none_of(table.begin(), table.end(), shines))
    refuse(entry.place, "[sky] '" + entry.file + "' is black: there is no light in it");
  return table;
}

}  // namespace torolux
