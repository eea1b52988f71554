// SPDX-License-Identifier: MIT
// The torus under load against BookSim 2's own results (tests/data/booksim_torus.csv).
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/unit/emulator/torus/torus_driver.hpp"

namespace torolux::test {

namespace {

struct Row {
  unsigned k;
  std::string traffic;
  std::uint32_t flits;
  double offered;  ///< flits per node and cycle
  double latency;  ///< mean, from creation to the tail's arrival [cycles]
  bool stable;
};

std::vector<Row> booksim_rows() {
  std::ifstream file(std::string(TOROLUX_SOURCE_DIR) + "/tests/data/booksim_torus.csv");
  std::vector<Row> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::vector<std::string> field;
    std::stringstream stream(line);
    for (std::string one; std::getline(stream, one, ',');) field.push_back(one);
    rows.push_back({static_cast<unsigned>(std::stoul(field[0])), field[1],
                    static_cast<std::uint32_t>(std::stoul(field[2])), std::stod(field[3]), std::stod(field[5]),
                    field[8] == "1"});
  }
  return rows;
}

/// BookSim's patterns (traffic.cpp), on a k x k torus.
unsigned destination(const std::string& traffic, unsigned from, unsigned k, std::minstd_rand& random) {
  const unsigned x = from % k;
  const unsigned y = from / k;
  const unsigned shift = (k - 1) / 2;
  if (traffic == "tornado") return (y + shift) % k * k + (x + shift) % k;
  if (traffic == "transpose") return x * k + y;
  if (traffic == "bitcomp") return k * k - 1 - from;
  return static_cast<unsigned>(random() / 7 % (k * k));  // uniform, oneself included
}

struct Measured {
  double latency;   ///< mean [cycles]
  double accepted;  ///< flits per node and cycle
};

/// Bernoulli injection at every node, as in BookSim: warm-up, then packets made in a window are measured.
Measured measure(const Row& row, double offered) {
  MachineDescription::Torus parameters;
  // The same storage: BookSim has 2 virtual channels of 16 flits at each input.
  parameters.buffer_packets = 32 / row.flits;
  TorusDriver driver(row.k, row.k, parameters);
  constexpr Cycles kWarmUp = 3000;
  const Cycles measured_until = kWarmUp + 12000;
  double sum = 0;
  std::uint64_t count = 0;
  std::uint64_t flits_out = 0;
  driver.on_delivery = [&](const TorusDriver::Delivery& delivery) {
    if (delivery.delivered >= kWarmUp && delivery.delivered < measured_until) flits_out += delivery.flits;
    if (delivery.sent < kWarmUp || delivery.sent >= measured_until) return;
    sum += static_cast<double>(delivery.delivered - delivery.sent);
    ++count;
  };
  std::minstd_rand random(12345);
  std::geometric_distribution<Cycles> gap(offered / row.flits);
  for (unsigned from = 0; from < row.k * row.k; ++from) {
    for (Cycles when = gap(random); when < measured_until; when += 1 + gap(random)) {
      driver.send(from, destination(row.traffic, from, row.k, random), row.flits, when);
    }
  }
  driver.run(measured_until + 5000);
  const double nodes = row.k * row.k;
  return {sum / static_cast<double>(std::max<std::uint64_t>(count, 1)),
          static_cast<double>(flits_out) / nodes / static_cast<double>(measured_until - kWarmUp)};
}

/// Rows of one k, traffic and packet size, ascending load.
std::map<std::string, std::vector<Row>> series() {
  std::map<std::string, std::vector<Row>> result;
  for (const Row& row : booksim_rows()) {
    result[std::to_string(row.k) + " " + row.traffic + " " + std::to_string(row.flits)].push_back(row);
  }
  return result;
}

TEST(TorusUnderLoad, LatencyIsBookSimsUpToHalfOfSaturation) {
  int compared = 0;
  for (const auto& [name, rows] : series()) {
    double saturation = 0;
    for (const Row& row : rows) saturation = row.stable ? std::max(saturation, row.offered) : saturation;
    const double zero_load = measure(rows.front(), 0.002).latency;
    // BookSim's zero-load latency: its least loaded row less the queueing that our model has there.
    const double booksim_zero =
        rows.front().latency - (measure(rows.front(), rows.front().offered).latency - zero_load);
    for (const Row& row : rows) {
      if (!row.stable || row.offered > saturation / 2 + 1e-9) continue;
      const double latency = measure(row, row.offered).latency - zero_load + booksim_zero;
      EXPECT_NEAR(latency, row.latency, 0.1 * row.latency) << name << " at " << row.offered;
      ++compared;
    }
  }
  EXPECT_GE(compared, 25);
}

TEST(TorusUnderLoad, SaturatesNoEarlierThanBookSim) {
  for (const auto& [name, rows] : series()) {
    for (const Row& row : rows) {
      if (!row.stable) continue;
      // Accepted as offered, to 3 %: some five standard deviations of the number of packets made in the window.
      const Measured measured = measure(row, row.offered);
      EXPECT_NEAR(measured.accepted, row.offered, 0.03 * row.offered + 0.002) << name << " at " << row.offered;
    }
  }
}

}  // namespace

}  // namespace torolux::test
