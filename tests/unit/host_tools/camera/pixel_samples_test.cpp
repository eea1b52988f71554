// SPDX-License-Identifier: MIT
// Where a pixel's samples lie: stratified, spread as the filter weighs, and with their middle on the pixel's.
#include "host_tools/camera/pixel_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace torolux {
namespace {

TEST(PixelPlace, OneSampleInEachStratum) {
  for (const std::uint32_t samples : {1U, 2U, 4U, 6U, 7U, 9U, 13U, 16U, 17U}) {
    std::set<std::uint32_t> columns;
    std::set<std::uint32_t> rows;
    std::set<std::pair<std::uint32_t, std::uint32_t>> cells;
    std::uint32_t across = static_cast<std::uint32_t>(std::sqrt(samples));
    while (samples % across != 0) --across;
    for (std::uint32_t s = 0; s < samples; ++s) {
      const PixelPlace place = pixel_place(s, samples, 77 + s);
      ASSERT_TRUE(place.x >= 0 && place.x < 1 && place.y >= 0 && place.y < 1);
      columns.insert(static_cast<std::uint32_t>(place.x * samples));
      rows.insert(static_cast<std::uint32_t>(place.y * samples));
      cells.emplace(static_cast<std::uint32_t>(place.x * across),
                    static_cast<std::uint32_t>(place.y * (samples / across)));
    }
    EXPECT_EQ(cells.size(), samples);
    EXPECT_EQ(columns.size(), samples);
    EXPECT_EQ(rows.size(), samples);
  }
}

/// Of pixels that may have more samples the first 2, 4, 8 ... are spread evenly: one in each of as many rows and
/// columns.
TEST(PixelPlace, OfAdaptiveSamplesTheFirstAreEven) {
  Quality quality;
  quality.samples = 4;
  quality.most_samples = 64;
  const PixelSamples samples(quality, 11);
  ASSERT_EQ(samples.count(), 64U);
  for (std::uint32_t bits = 1; bits <= 6; ++bits) {
    std::set<std::uint32_t> columns, rows;
    for (const protocol::SamplePlace& place : samples.places().first(1U << bits)) {
      columns.insert(place.x >> (32U - bits));
      rows.insert(place.y >> (32U - bits));
    }
    EXPECT_EQ(columns.size(), 1U << bits);
    EXPECT_EQ(rows.size(), 1U << bits);
  }
}

/// Weight of a filter at a distance from the middle, of integral one: the definitions in pixel_samples.hpp.
double weight(PixelFilter filter, double x) {
  if (filter == PixelFilter::box) return std::fabs(x) <= 0.5 ? 1 : 0;
  if (filter == PixelFilter::tent) return std::fmax(0, 1 - std::fabs(x));
  constexpr double kept = 0.99730020393674;  // of a Gaussian within three standard deviations
  return std::fabs(x) <= 1.5 ? std::exp(-2 * x * x) * std::sqrt(2 / std::acos(-1.0)) / kept : 0;
}

TEST(PixelFilters, DistancesLieAsTheFilterWeighs) {
  for (const auto& [name, filter] : kPixelFilters) {
    double before = filter_distance(filter, 0.0005);
    for (int i = 1; i < 1000; ++i) {  // as many in each interval: density = step of u / step of x
      const double next = filter_distance(filter, (i + 0.5) / 1000);
      ASSERT_GT(next, before) << name;
      EXPECT_NEAR(0.001 / (next - before), weight(filter, (before + next) / 2), 0.005) << name << " at " << next;
      EXPECT_NEAR(filter_distance(filter, 1 - (i + 0.5) / 1000), -next, 1e-9) << name << " is symmetric";
      before = next;
    }
  }
}

TEST(PixelFilters, HaveNames) {
  for (const auto& [name, filter] : kPixelFilters) {
    EXPECT_EQ(name_of(filter), name);
    EXPECT_EQ(filter_named(name), filter);
  }
  EXPECT_EQ(filter_named("triangle"), std::nullopt);
}

/// As the rays of a picture have it.
PixelPlace place_in(const PixelSamples& samples, std::uint32_t column, std::uint32_t row, std::uint32_t sample) {
  protocol::CameraView view{};
  view.width = 64;
  view.height = 64;
  view.filter_bits = samples.filter_bits();
  const protocol::CameraPixel pixel = protocol::camera_pixel(view, column, row);
  const protocol::SamplePlace place = samples.places()[sample];
  const auto distance = [&](std::uint32_t part) {
    return static_cast<double>(protocol::filter_distance(samples.distances(), view.filter_bits, part));
  };
  return {0.5 + distance(place.x + pixel.moved_x), 0.5 + distance(place.y + pixel.moved_y)};
}

// What is rounded for the PEs lies in the same strata.
TEST(PixelSamples, StayApart) {
  for (const std::uint32_t count : {2U, 4U, 7U, 16U, 17U, 60U, 256U}) {
    const PixelSamples samples(PixelFilter::box, count, 9);
    std::set<std::uint64_t> columns;
    std::set<std::uint64_t> rows;
    for (const protocol::SamplePlace& place : samples.places()) {
      columns.insert(std::uint64_t{place.x} * count >> 32U);
      rows.insert(std::uint64_t{place.y} * count >> 32U);
    }
    EXPECT_EQ(columns.size(), count);
    EXPECT_EQ(rows.size(), count);
  }
}

// Between the table's steps, too. A thousandth of a pixel but in the steps where the curve is steepest.
TEST(PixelSamples, TheTableIsTheFilter) {
  for (const auto& [name, filter] : kPixelFilters) {
    const PixelSamples samples(filter, 2, 3);
    for (std::uint32_t i = 0; i <= 5000; ++i) {
      const double u = i / 5000.0;
      const auto part = static_cast<std::uint32_t>(std::fmin(u * 0x1p32, 0xFFFF'FFFF));
      const bool steep = u < 0.003 || u > 0.997;
      EXPECT_NEAR(static_cast<double>(protocol::filter_distance(samples.distances(), samples.filter_bits(), part)),
                  filter_distance(filter, u), steep ? 0.02 : 1e-3)
          << name << " at " << u;
    }
  }
}

// Over a few pixels together: no pattern moves the picture, and what an edge covers of a row of pixels is right though
// it covers a little of each.
TEST(PixelSamples, NeighboursShareOutThePixel) {
  for (const auto& [name, filter] : kPixelFilters) {
    const PixelSamples samples(filter, 8, 3);
    double x = 0;
    double y = 0;
    int covered = 0;
    for (std::uint32_t pixel = 0; pixel < 64; ++pixel) {
      for (std::uint32_t sample = 0; sample < samples.count(); ++sample) {
        const PixelPlace place = place_in(samples, pixel % 8, pixel / 8, sample);
        x += place.x;
        y += place.y;
        covered += place.y < 0.3 ? 1 : 0;
      }
    }
    EXPECT_NEAR(x / 512, 0.5, 0.02) << name;
    EXPECT_NEAR(y / 512, 0.5, 0.02) << name;
    if (filter != PixelFilter::box) continue;
    EXPECT_NEAR(covered / 512.0, 0.3, 0.01);
  }
  EXPECT_EQ(place_in(PixelSamples(PixelFilter::tent, 1, 3), 5, 7, 0).x, 0.5);
}

// Mean squares of the distances are the filters' own: 1/12, 1/6, and a little less than 1/4.
TEST(PixelSamples, SpreadAsTheFilterDoes) {
  constexpr std::array<double, 3> wanted{1.0 / 12, 1.0 / 6, 0.2433};
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const PixelSamples samples(kPixelFilters[i].filter, 256, 3);
    double square = 0;
    for (std::uint32_t sample = 0; sample < 256; ++sample) {
      const double x = place_in(samples, 2, 3, sample).x - 0.5;
      square += x * x;
    }
    EXPECT_NEAR(square / 256, wanted[i], 0.02 * wanted[i]) << kPixelFilters[i].name;
  }
}

}  // namespace
}  // namespace torolux
