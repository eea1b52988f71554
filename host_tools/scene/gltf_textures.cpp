// SPDX-License-Identifier: MIT
// Follows textures to samplers and images.
#include "host_tools/scene/gltf_textures.hpp"

#include <cmath>
#include <numbers>

#include "host_tools/scene/find_file.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/texture_image.hpp"
#include "host_tools/scene/textures.hpp"

namespace torolux {
namespace {

constexpr std::size_t kMostCode = 0xFFFF;  // of OpenGL
constexpr std::size_t kRepeat = 10497;
constexpr std::size_t kClampToEdge = 33071;
constexpr std::size_t kMostSets = 1000;

MeanTexel mean_of(const SceneTexture& image) {
  MeanTexel mean{{0, 0, 0}, {0, 0, 0}};
  std::array<std::array<std::uint64_t, 256>, 3> counts{};
  for (const auto& texel : image.texels)
    for (std::size_t c = 0; c < 3; ++c) ++counts[c][texel[c]];
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t value = 0; value < 256; ++value) {
      const double share = static_cast<double>(counts[c][value]) / static_cast<double>(image.texels.size());
      mean.linear[c] += share * linear_of_srgb(static_cast<std::uint8_t>(value));
      mean.raw[c] += share * static_cast<double>(value) / 255;
    }
  }
  return mean;
}

}  // namespace

std::array<double, 2> GltfMapping::placed(double u, double v) const {
  // KHR_texture_transform: translation * rotation * scale.
  const double x = u * scale[0];
  const double y = v * scale[1];
  const double cosine = std::cos(rotation);
  const double sine = std::sin(rotation);
  return {cosine * x + sine * y + offset[0], 1 - (-sine * x + cosine * y + offset[1])};
}

std::optional<std::size_t> GltfTextures::image_of(const GltfObject& info, const Place& place) {
  const auto number = info.index("index", root_.count("textures"), "textures");
  if (!number) refuse(place, "refers to a texture without its 'index'");
  const GltfObject texture = root_.element("textures", *number, "texture");
  const auto image = texture.index("source", root_.count("images"), "images");
  if (!image)
    notices_.note("a texture has no image in a form that is read (PNG, JPEG, TGA, BMP): it is not used",
                  texture.place());
  return image;
}

TextureUse GltfTextures::use(const GltfObject& info, const Place& place, GltfMapping& mapping) {
  TextureUse use;
  const auto number = image_of(info, place);
  if (!number) return use;
  const GltfImage image = data_.image(*number);
  use.names = {image.name};
  use.bytes = image.bytes;
  use.place = place;
  use.folders = {data_.folder()};
  std::size_t set = info.integer("texCoord", kMostSets).value_or(0);
  if (const auto transform = info.extension("KHR_texture_transform")) {
    if (const auto offset = transform->numbers("offset", 2)) mapping.offset = {(*offset)[0], (*offset)[1]};
    if (const auto scale = transform->numbers("scale", 2)) mapping.scale = {(*scale)[0], (*scale)[1]};
    mapping.rotation = transform->number("rotation", -kMostCoordinate, kMostCoordinate).value_or(0);
    set = transform->integer("texCoord", kMostSets).value_or(set);
  }
  mapping.attribute = "TEXCOORD_" + std::to_string(set);
  const auto texture = root_.element("textures", *info.index("index", root_.count("textures"), "textures"), "texture");
  if (const auto sampler = texture.index("sampler", root_.count("samplers"), "samplers")) {
    const GltfObject wrap = root_.element("samplers", *sampler, "sampler");
    const std::size_t u = wrap.integer("wrapS", kMostCode).value_or(kRepeat);
    const std::size_t v = wrap.integer("wrapT", kMostCode).value_or(kRepeat);
    use.clamp = u == kClampToEdge && v == kClampToEdge;
    mapping.odd_wrap = !use.clamp && (u != kRepeat || v != kRepeat);
  }
  return use;
}

std::optional<MeanTexel> GltfTextures::mean(const GltfObject& info, const Place& place) {
  const auto number = image_of(info, place);
  if (!number) return std::nullopt;
  const auto [held, fresh] = means_.try_emplace(*number);
  if (!fresh) return held->second;
  const GltfImage image = data_.image(*number);
  if (image.bytes) return held->second = mean_of(decode_texture(*image.bytes, image.name, place, notices_).colours);
  const auto found = find_file(image.name, std::array{data_.folder()}, files_, place);
  if (!found) {
    notices_.note("there is no texture, its factor alone is used", place, in_quotes(image.name));
    return std::nullopt;
  }
  const std::string file = found->path.string();
  return held->second =
             mean_of(decode_texture(files_.read(file, place, kMostImageBytes), file, place, notices_).colours);
}

}  // namespace torolux
