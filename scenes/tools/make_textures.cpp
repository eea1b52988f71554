// SPDX-License-Identifier: MIT
// Writes the textures of scenes/textured_walls as PNG: make_textures brick|planks|rug|painting. All but the painting
// repeat without seams.
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace {

using Colour = std::array<double, 3>;  // sRGB, 0..255

Colour mix(const Colour& a, const Colour& b, double share) {
  return {a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, a[2] + (b[2] - a[2]) * share};
}

Colour times(const Colour& a, double factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor};
}

/// Uniform in 0..1, a hash of three numbers (finaliser "lowbias32" of C. Wellons).
double noise(int x, int y, int z) {
  auto h = static_cast<std::uint32_t>(x) * 0x9E37'79B1U + static_cast<std::uint32_t>(y) * 0x85EB'CA77U +
           static_cast<std::uint32_t>(z) * 0xC2B2'AE3DU;
  h ^= h >> 16U;
  h *= 0x21F0'AAADU;
  h ^= h >> 15U;
  h *= 0x735A'2D97U;
  h ^= h >> 15U;
  return h / 4294967296.0;
}

/// Noise of `cells` per period, smoothly between them; x, y in periods.
double smooth_noise(double x, double y, int columns, int rows, int seed) {
  const double cx = x * columns;
  const double cy = y * rows;
  const auto i = static_cast<int>(std::floor(cx));
  const auto j = static_cast<int>(std::floor(cy));
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double a = ease(cx - i);
  const double b = ease(cy - j);
  const auto at = [&](int p, int q) {
    return noise(((p % columns) + columns) % columns, ((q % rows) + rows) % rows, seed);
  };
  const double low = at(i, j) + (at(i + 1, j) - at(i, j)) * a;
  const double high = at(i, j + 1) + (at(i + 1, j + 1) - at(i, j + 1)) * a;
  return low + (high - low) * b;
}

/// Four courses of two bricks, every other one moved by half a brick.
Colour brick(double x, double y) {
  const double course = y * 4;
  const auto row = static_cast<int>(course);
  double along = x * 2 + (row % 2 == 0 ? 0 : 0.5);
  const int column = static_cast<int>(along) % 2;
  along -= std::floor(along);
  const double up = course - row;
  // Distance to the edge of the brick, in brick heights; edges are a little worn.
  const double worn = 0.035 * (smooth_noise(x, y, 24, 24, 1) - 0.5);
  const double edge = std::min({along * 2, (1 - along) * 2, up, 1 - up}) + worn;
  const double grain = smooth_noise(x, y, 48, 48, 2);
  const Colour mortar = times({190, 182, 170}, 0.9 + 0.15 * grain);
  const double shade = 0.78 + 0.34 * noise(column, row, 3);
  const Colour clay = times(mix({158, 74, 52}, {176, 104, 70}, noise(column, row, 4)), shade * (0.9 + 0.18 * grain));
  return mix(mortar, clay, std::clamp((edge - 0.06) / 0.05, 0.0, 1.0));
}

/// Four planks side by side, running along x, each with one joint.
Colour planks(double x, double y) {
  const auto plank = static_cast<int>(y * 4);
  const double across = y * 4 - plank;
  const double start = noise(plank, 0, 5);
  double along = x + start;
  const int board = static_cast<int>(std::floor(along));
  along -= board;
  const double tone = noise(plank, board % 2, 6);
  const double bend = 0.5 * smooth_noise(x, y, 4, 16, 7);
  const double rings = 0.5 + 0.5 * std::sin(2 * std::numbers::pi * (across * 5 + bend * 3 + 5 * start));
  const double grain = smooth_noise(x, y, 16, 128, 8);
  Colour wood = mix({150, 104, 62}, {186, 138, 88}, 0.35 * tone + 0.4 * rings + 0.25 * grain);
  wood = times(wood, 0.86 + 0.2 * tone);
  const double gap = std::min({across, 1 - across, along * 4, (1 - along) * 4});
  return mix({62, 40, 24}, wood, std::clamp(gap / 0.06, 0.0, 1.0));
}

/// Diamonds within borders; the whole rug.
Colour rug(double x, double y) {
  const Colour red{132, 32, 34};
  const Colour blue{28, 42, 84};
  const Colour cream{226, 208, 168};
  const double border = std::min({x * 3, (1 - x) * 3, y * 4, (1 - y) * 4});
  const double weave = 0.93 + 0.07 * noise(static_cast<int>(x * 96), static_cast<int>(y * 128), 9);
  if (border < 0.1) return times(cream, weave);
  if (border < 0.42) {
    const bool dot = (std::fmod(x * 24 + 0.5, 1.0) < 0.5) != (std::fmod(y * 32 + 0.5, 1.0) < 0.5);
    return times(dot && border > 0.2 && border < 0.32 ? cream : blue, weave);
  }
  if (border < 0.5) return times(cream, weave);
  const double u = std::fabs(std::fmod(x * 4, 1.0) - 0.5);
  const double v = std::fabs(std::fmod(y * 6, 1.0) - 0.5);
  const double diamond = u + v;
  return times(diamond < 0.16 ? cream : diamond < 0.34 ? blue : red, weave);
}

/// Sun over hills and water; y upwards.
Colour painting(double x, double y) {
  Colour colour = mix({250, 190, 110}, {66, 96, 160}, std::clamp((y - 0.4) * 1.7, 0.0, 1.0));
  const double sun = std::hypot((x - 0.64) * 1.33, y - 0.62);
  colour = mix({255, 246, 214}, colour, std::clamp((sun - 0.07) / 0.02, 0.0, 1.0));
  for (int ridge = 0; ridge < 3; ++ridge) {
    const double height = 0.56 - 0.08 * ridge + 0.12 * (smooth_noise(x, 0, 5 + 2 * ridge, 1, 20 + ridge) - 0.5);
    if (y < height) colour = mix({104, 96, 132}, {38, 58, 54}, ridge / 2.0);
  }
  if (y < 0.26) {
    const double wave = smooth_noise(x, y, 8, 64, 30);
    colour = mix({52, 78, 118}, {236, 178, 112}, 0.55 * wave * std::exp(-6 * std::fabs(x - 0.64)) + 0.15 * wave);
  }
  return colour;
}

bool write(std::uint32_t width, std::uint32_t height, const std::function<Colour(double, double)>& paint) {
  std::vector<std::uint8_t> pixels;
  for (std::uint32_t row = 0; row < height; ++row) {
    for (std::uint32_t column = 0; column < width; ++column) {
      const Colour colour = paint((column + 0.5) / width, 1 - (row + 0.5) / height);
      // Steps of four: finer ones would not be seen, and make the file twice as long.
      for (const double c : colour) {
        pixels.push_back(static_cast<std::uint8_t>(std::clamp(std::round(c / 4) * 4, 0.0, 252.0)));
      }
    }
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  return png_image_write_to_stdio(&image, stdout, 0, pixels.data(), 0, nullptr) != 0;
}

}  // namespace

int main(int count, char** words) {
  const std::string name = count == 2 ? words[1] : "";
  bool done = false;
  if (name == "brick") done = write(128, 128, brick);
  if (name == "planks") done = write(128, 128, planks);
  if (name == "rug") done = write(96, 128, rug);
  if (name == "painting") done = write(128, 96, painting);
  if (!done) std::fprintf(stderr, "usage: make_textures brick|planks|rug|painting > FILE.png\n");
  return done ? 0 : 1;
}
