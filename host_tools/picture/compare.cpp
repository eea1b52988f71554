// SPDX-License-Identifier: MIT
// Two pictures enter; by how much they differ leaves.
#include "host_tools/picture/compare.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

constexpr std::uint32_t kBlock = 4;
constexpr double kClampPercentile = 0.97;

void check(const Picture& picture, const char* which) {
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    for (const float value : picture.pixels[i]) {
      if (std::isfinite(value)) continue;
      throw InputError(std::string("the ") + which + " picture has a value that is not a finite number at pixel (" +
                       std::to_string(i % picture.width) + ", " + std::to_string(i / picture.width) + ")");
    }
  }
}

std::array<double, 3> mean_of(const Picture& picture) {
  std::array<double, 3> sum{};
  for (const auto& pixel : picture.pixels)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += double{pixel[c]};
  for (double& value : sum) value /= static_cast<double>(picture.pixels.size());
  return sum;
}

double percentile(const Picture& picture, double fraction) {
  std::vector<float> values;
  values.reserve(picture.pixels.size() * 3);
  for (const auto& pixel : picture.pixels) values.insert(values.end(), pixel.begin(), pixel.end());
  const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return double{values[static_cast<std::size_t>(rank)]};
}

/// Mean over one block, each value clamped.
std::array<double, 3> block_mean(const Picture& picture, std::uint32_t x0, std::uint32_t y0, double clamp) {
  const std::uint32_t x1 = std::min(x0 + kBlock, picture.width);
  const std::uint32_t y1 = std::min(y0 + kBlock, picture.height);
  std::array<double, 3> sum{};
  for (std::uint32_t y = y0; y < y1; ++y)
    for (std::uint32_t x = x0; x < x1; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += std::min(double{picture.pixels[std::size_t{y} * picture.width + x][c]}, clamp);
  for (double& value : sum) value /= static_cast<double>((x1 - x0) * (y1 - y0));
  return sum;
}

/// sqrt(sum of squared differences / sum of squares of the reference).
class RelativeError {
 public:
  void add(double value, double reference) {
    difference_ += (value - reference) * (value - reference);
    reference_ += reference * reference;
  }
  double value() const {
    if (difference_ == 0) return 0;
    return reference_ > 0 ? std::sqrt(difference_ / reference_) : std::numeric_limits<double>::infinity();
  }

 private:
  double difference_ = 0;
  double reference_ = 0;
};

double block_rmse(const Picture& picture, const Picture& reference, double clamp) {
  RelativeError error;
  for (std::uint32_t y = 0; y < picture.height; y += kBlock) {
    for (std::uint32_t x = 0; x < picture.width; x += kBlock) {
      const auto a = block_mean(picture, x, y, clamp);
      const auto b = block_mean(reference, x, y, clamp);
      for (std::size_t c = 0; c < 3; ++c) error.add(a[c], b[c]);
    }
  }
  return error.value();
}

bool same_bits(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return std::bit_cast<std::array<std::uint32_t, 3>>(a) == std::bit_cast<std::array<std::uint32_t, 3>>(b);
}

}  // namespace

Comparison compare(const Picture& picture, const Picture& reference) {
  if (picture.width != reference.width || picture.height != reference.height)
    throw InputError("pictures of different sizes cannot be compared: " + std::to_string(picture.width) + " x " +
                     std::to_string(picture.height) + " and " + std::to_string(reference.width) + " x " +
                     std::to_string(reference.height) + " pixels");
  check(picture, "first");
  check(reference, "second");
  Comparison result;
  result.mean = mean_of(picture);
  result.reference_mean = mean_of(reference);
  RelativeError error;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    if (!same_bits(picture.pixels[i], reference.pixels[i])) ++result.differing;
    for (unsigned c = 0; c < 3; ++c) {
      const double a = double{picture.pixels[i][c]};
      const double b = double{reference.pixels[i][c]};
      error.add(a, b);
      if (std::fabs(a - b) <= result.worst) continue;
      result.worst = std::fabs(a - b);
      result.worst_x = static_cast<std::uint32_t>(i % picture.width);
      result.worst_y = static_cast<std::uint32_t>(i / picture.width);
      result.worst_channel = c;
    }
  }
  result.relative_rmse = error.value();
  result.clamp = percentile(reference, kClampPercentile);
  result.block_rmse = block_rmse(picture, reference, result.clamp);
  return result;
}

Picture difference(const Picture& picture, const Picture& reference) {
  Picture result{picture.width, picture.height, picture.pixels};
  for (std::size_t i = 0; i < result.pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) result.pixels[i][c] = std::fabs(picture.pixels[i][c] - reference.pixels[i][c]);
  return result;
}

}  // namespace torolux
