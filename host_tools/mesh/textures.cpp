// SPDX-License-Identifier: MIT
// sRGB becomes linear, means over areas leave as many texels as are allowed, and each is packed as square roots. Means
// over a triangle are taken at the middles of small parts, in a halved image.
#include "host_tools/mesh/textures.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/scene/textures.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Which texels lie under one of `to` equal parts of an edge of `from`, and the shares of the part that they cover.
struct Cover {
  std::uint32_t first;
  std::vector<double> shares;
};
Cover cover(std::uint32_t part, std::uint32_t to, std::uint32_t from) {
  const double size = static_cast<double>(from) / to;
  const double begin = part * size;
  const double end = part + 1 == to ? from : begin + size;
  Cover result{static_cast<std::uint32_t>(begin), {}};
  for (std::uint32_t i = result.first; i < from && i < end; ++i) {
    result.shares.push_back((std::min(end, i + 1.0) - std::max(begin, static_cast<double>(i))) / size);
  }
  return result;
}

/// Means over the areas of the new texels. width, height: not greater than the image's.
LinearImage shrunk(const LinearImage& image, std::uint32_t width, std::uint32_t height) {
  LinearImage result{width, height, std::vector<Vec3d>(std::size_t{width} * height)};
  for (std::uint32_t y = 0; y < height; ++y) {
    const Cover rows = cover(y, height, image.height);
    for (std::uint32_t x = 0; x < width; ++x) {
      const Cover columns = cover(x, width, image.width);
      Vec3d sum{0, 0, 0};
      for (std::size_t j = 0; j < rows.shares.size(); ++j) {
        for (std::size_t i = 0; i < columns.shares.size(); ++i) {
          const Vec3d& colour = image.colours[(rows.first + j) * image.width + columns.first + i];
          sum = vec::add(sum, vec::scale(colour, rows.shares[j] * columns.shares[i]));
        }
      }
      result.colours[std::size_t{y} * width + x] = sum;
    }
  }
  return result;
}

LinearImage linear(const SceneTexture& texture) {
  std::array<double, 256> shares{};
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = linear_of_srgb(static_cast<std::uint8_t>(i));
  LinearImage image{texture.width, texture.height, {}};
  image.colours.reserve(texture.texels.size());
  for (const auto& texel : texture.texels) {
    image.colours.push_back({shares[texel[0]], shares[texel[1]], shares[texel[2]]});
  }
  return image;
}

/// A texel more on each side, as those next to it.
LinearImage with_border(const LinearImage& image) {
  LinearImage result{image.width + 2, image.height + 2, {}};
  for (std::uint32_t y = 0; y < result.height; ++y) {
    const std::uint32_t row = std::clamp(y, 1U, image.height) - 1;
    for (std::uint32_t x = 0; x < result.width; ++x)
      result.colours.push_back(image.colours[std::size_t{row} * image.width + std::clamp(x, 1U, image.width) - 1]);
  }
  return result;
}

protocol::Texel packed(const Vec3d& colour) {
  protocol::Texel texel = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double root = std::sqrt(std::clamp(colour[c], 0.0, 1.0)) * 1023;
    texel |= static_cast<protocol::Texel>(root + 0.5) << (10U * c);
  }
  return texel;
}

}  // namespace

MachineTexture machine_texture(const SceneTexture& image, std::uint32_t most_texels) {
  const double texels = static_cast<double>(image.width) * image.height;
  const double longest = std::max(image.width, image.height);
  const std::uint32_t border = image.clamped ? 1 : 0;
  const std::uint32_t most_edge = protocol::kMostTextureEdge - 2 * border;
  const double scale = std::min({1.0, std::sqrt(most_texels / texels), most_edge / longest});
  // A texture that is much longer than wide keeps one row at least, and no more columns than there may be texels.
  const auto edge = [&](std::uint32_t size) {
    return std::clamp(static_cast<std::uint32_t>(size * scale + 1e-9), 1U, std::min(size, most_texels));
  };
  LinearImage result = linear(image);
  if (edge(image.width) < image.width || edge(image.height) < image.height) {
    result = shrunk(result, edge(image.width), edge(image.height));
  }
  if (image.clamped) result = with_border(result);
  MachineTexture machine{result.width, result.height, {}, border};
  machine.texels.reserve(result.colours.size());
  for (const Vec3d& colour : result.colours) machine.texels.push_back(packed(colour));
  return machine;
}

protocol::TexturePoint MachineTexture::placed(protocol::TexturePoint point) const {
  if (border == 0) return point;
  const auto within = [this](float x, std::uint32_t size) {
    const float inner = std::clamp(x, 0.0F, 1.0F) * static_cast<float>(size - 2 * border);
    return (inner + static_cast<float>(border)) / static_cast<float>(size);
  };
  return {within(point.u, width), within(point.v, height)};
}

TextureMeans::TextureMeans(const MachineTexture& texture) {
  LinearImage image{texture.width, texture.height, {}};
  image.colours.reserve(texture.texels.size());
  for (const protocol::Texel texel : texture.texels) {
    const protocol::Vec3f colour = protocol::texel_colour(texel);
    image.colours.push_back({colour[0], colour[1], colour[2]});
  }
  levels_.push_back(image);
  while (image.width > 1 || image.height > 1) {
    image = shrunk(image, (image.width + 1) / 2, (image.height + 1) / 2);
    levels_.push_back(image);
  }
}

Vec3d TextureMeans::over(const std::array<protocol::TexturePoint, 3>& corner) const {
  // Middles of the n * n parts of a uniform grid, of a texel or less each, from the first level at which n is not too
  // great.
  constexpr double kMostParts = 48;
  double across = 0;
  double up = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const protocol::TexturePoint& a = corner[i];
    const protocol::TexturePoint& b = corner[(i + 1) % 3];
    across = std::max(across, std::fabs(static_cast<double>(a.u) - static_cast<double>(b.u)));
    up = std::max(up, std::fabs(static_cast<double>(a.v) - static_cast<double>(b.v)));
  }
  std::size_t number = 0;
  const auto parts = [&] { return std::max(across * levels_[number].width, up * levels_[number].height); };
  while (number + 1 < levels_.size() && parts() > kMostParts) ++number;
  const LinearImage& level = levels_[number];
  const auto n = static_cast<std::uint32_t>(std::clamp(std::ceil(parts()), 1.0, kMostParts));
  Vec3d sum{0, 0, 0};
  const auto add = [&](std::uint32_t i, std::uint32_t j, double thirds) {
    const double b1 = (i + thirds / 3) / n;
    const double b2 = (j + thirds / 3) / n;
    const auto at = [&](float a, float b, float c) {
      return static_cast<float>(static_cast<double>(a) * (1 - b1 - b2) + static_cast<double>(b) * b1 +
                                static_cast<double>(c) * b2);
    };
    const auto x = protocol::texel_pair(at(corner[0].u, corner[1].u, corner[2].u), level.width);
    const auto y = protocol::texel_pair(at(corner[0].v, corner[1].v, corner[2].v), level.height);
    const auto colour = [&](std::uint32_t row, std::uint32_t column) {
      return level.colours[std::size_t{row} * level.width + column];
    };
    const auto row = [&](std::uint32_t r) {
      return vec::add(vec::scale(colour(r, x.first), 1 - static_cast<double>(x.share)),
                      vec::scale(colour(r, x.second), static_cast<double>(x.share)));
    };
    sum = vec::add(sum, vec::add(vec::scale(row(y.first), 1 - static_cast<double>(y.share)),
                                 vec::scale(row(y.second), static_cast<double>(y.share))));
  };
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i + j < n; ++i) {
      add(i, j, 1);
      if (i + j + 1 < n) add(i, j, 2);
    }
  }
  return vec::scale(sum, 1.0 / (double{1} * n * n));
}

}  // namespace torolux
