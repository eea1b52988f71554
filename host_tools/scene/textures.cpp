// SPDX-License-Identifier: MIT
// Finds, reads and keeps the images that materials name.
#include "host_tools/scene/textures.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/scene/texture_image.hpp"

namespace torolux {

namespace {

/// Colours of texels that are not there would shine through at the edges: they get the mean of the others.
void fill_hidden(DecodedImage& image) {
  std::array<std::uint64_t, 3> sum{};
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    if (image.alpha[i] < 128) continue;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += image.colours.texels[i][c];
    ++count;
  }
  for (std::size_t i = 0; count > 0 && i < image.alpha.size(); ++i) {
    if (image.alpha[i] >= 128) continue;
    for (std::size_t c = 0; c < 3; ++c) image.colours.texels[i][c] = static_cast<std::uint8_t>(sum[c] / count);
  }
}

std::uint8_t with_base_and_gain(std::uint8_t value, const TextureUse& use) {
  if (use.base == 0 && use.gain == 1) return value;
  return static_cast<std::uint8_t>(std::lround(std::clamp(255 * use.base + use.gain * value, 0.0, 255.0)));
}

/// Straight from 0 to the cutoff, and from there to 1: where alpha was the cutoff it is then one half.
void move_cutoff(double cutoff, std::vector<std::uint8_t>& alpha) {
  if (cutoff == 0.5) return;
  for (std::uint8_t& value : alpha) {
    const double a = value / 255.0;
    const double moved = a < cutoff ? a / cutoff * 127 : 128 + (cutoff < 1 ? (a - cutoff) / (1 - cutoff) * 127 : 0);
    value = static_cast<std::uint8_t>(moved);
  }
}

/// Into the image's alpha.
void opacity_of(char channel, DecodedImage& image) {
  if (channel == 'm' && image.alpha.empty()) image.alpha.assign(image.colours.texels.size(), 255);
  if (channel == 'm' || (channel == 0 && !image.alpha.empty())) return;
  image.alpha.clear();
  const std::size_t colour = std::string_view("rgb").find(channel);
  for (const auto& texel : image.colours.texels) {
    const int mean = (texel[0] + texel[1] + texel[2] + 1) / 3;
    image.alpha.push_back(colour < 3 ? texel[colour] : static_cast<std::uint8_t>(mean));
  }
}

}  // namespace

double linear_of_srgb(std::uint8_t value) {
  const double v = value / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::optional<std::string> TextureLibrary::find(const TextureUse& use) const {
  if (use.bytes) return use.names[0];
  for (const std::string& name : use.names) {
    const auto found = find_file(name, use.folders, files_, use.place);
    if (!found) continue;
    const std::string file = found->path.string();
    if (!found->as_written || name != use.names[0])
      notices_.note("a texture is found under another name", use.place,
                    in_quotes(use.names[0]) + " is " + in_quotes(file));
    return file;
  }
  if (use.optional) {
    notices_.note("a texture without a file name: no texture", use.place);
    return std::nullopt;
  }
  if (missing_ == MissingMaterials::refuse)
    refuse(use.place,
           "there is no texture '" + (use.folders.at(0) / use.names[0]).lexically_normal().string() +
               "'; put it there (names are relative to the file that names them), take the line out, give the "
               "material in scene.toml, or use --missing-materials white");
  notices_.note("there is no texture, white stands for it", use.place, in_quotes(use.names[0]));
  return std::nullopt;
}

std::string TextureLibrary::read(const TextureUse& use, const std::string& file) const {
  return use.bytes ? *use.bytes : files_.read(file, use.place, kMostImageBytes);
}

std::uint32_t TextureLibrary::load(const TextureUse& use) {
  const auto file = find(use);
  if (!file) return kNoImage;
  const auto [entry, fresh] = number_.emplace(std::tuple(*file, use.base, use.gain, use.cutoff, use.clamp),
                                              static_cast<std::uint32_t>(textures_.size()));
  if (!fresh) return entry->second;
  DecodedImage image = decode_texture(read(use, *file), *file, use.place, notices_);
  for (auto& texel : image.colours.texels)
    for (std::uint8_t& value : texel) value = with_base_and_gain(value, use);
  masks_.emplace_back();
  if (use.cutoff == 0) image.alpha.clear();
  if (!image.alpha.empty()) {
    if (use.cutoff == 0.5)
      notices_.note("the alpha of a texture cuts its faces out: less than one half is not there", use.place,
                    in_quotes(*file));
    move_cutoff(use.cutoff, image.alpha);
    masks_.back() = cut_out_mask(image.alpha, image.colours.width, image.colours.height);
    fill_hidden(image);
  }
  image.colours.clamped = use.clamp;
  textures_.push_back(std::move(image.colours));
  return entry->second;
}

std::optional<CutOutMask> TextureLibrary::load_mask(const TextureUse& use) {
  const auto file = find(use);
  if (!file) return std::nullopt;
  DecodedImage image = decode_texture(read(use, *file), *file, use.place, notices_);
  notices_.note("map_d cuts faces out: less than one half is not there", use.place, in_quotes(*file));
  opacity_of(use.channel, image);
  for (std::uint8_t& value : image.alpha) value = with_base_and_gain(value, use);
  move_cutoff(use.cutoff, image.alpha);
  return cut_out_mask(image.alpha, image.colours.width, image.colours.height);
}

Vec3d TextureLibrary::brightest(std::uint32_t texture) const {
  std::array<std::uint8_t, 3> most{};
  for (const auto& texel : textures_[texture].texels) {
    for (std::size_t c = 0; c < 3; ++c) most[c] = std::max(most[c], texel[c]);
  }
  return {linear_of_srgb(most[0]), linear_of_srgb(most[1]), linear_of_srgb(most[2])};
}

}  // namespace torolux
