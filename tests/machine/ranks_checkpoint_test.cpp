// SPDX-License-Identifier: MIT
// Proves: a render that is interrupted again and again, with payloads in the network that other ranks hold, and each
// time goes on from its checkpoint on another number of ranks, other placing and delays of messages, or in one process,
// ends as one that never was, in one process.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <string>

#include "emulator/errors.hpp"
#include "emulator/remote/wire.hpp"
#include "tests/physics/same_picture.hpp"
#include "tests/support/on_ranks.hpp"
#include "tests/support/run_in_pieces.hpp"

namespace torolux::test {
namespace {

using remote::Placing;
using std::chrono_literals::operator""us;

/// Each goes on from what the one before it has left; ranks 1: one process.
constexpr std::array<OnRanks, 7> kPlaces = {{{3, 1, Placing::cyclic, {1, 100us}},
                                             {2, 2, Placing::block, {}},
                                             {1, 2, Placing::block, {}},
                                             {5, 1, Placing::random, {2, 200us}},
                                             {1, 1, Placing::block, {}},
                                             {9, 1, Placing::block, {3, 50us}},
                                             {3, 2, Placing::random, {}}}};

/// Bytes of payloads that rank 0 has had to fetch to save what was in the network.
std::size_t fetched = 0;

RenderResult run_at(const OnRanks& place, RenderCase piece) {
  const auto count = [](const ranks::Message& message) {
    if (message.kind == static_cast<std::uint32_t>(remote::Kind::kept)) fetched += message.bytes.size();
    return true;
  };
  if (place.ranks != 1) return render_on(place, piece, count);
  piece.machine.threads = place.threads;
  return run_case(piece);
}

void expect_same_in_pieces(const RenderCase& render_case, unsigned messages, unsigned least_pieces) {
  const RenderResult whole = run_case(render_case);
  fetched = 0;
  const Pieces pieces = run_in_pieces(render_case, messages, {}, true, [](const RenderCase& piece, unsigned number) {
    return run_at(kPlaces[number % kPlaces.size()], piece);
  });
  EXPECT_GE(pieces.interruptions, least_pieces);
  EXPECT_GT(fetched, 0U);
  EXPECT_EQ(everything(pieces.result), everything(whole));
  EXPECT_EQ(bytes_of(pieces.result.picture), bytes_of(whole.picture));
}

RenderCase small_case() {
  RenderCase small = small_cornell();
  small.machine.engine = "translated";
  small.machine.threads = 1;
  small.machine.columns = 3;
  small.quality.max_shots = 5;
  return small;
}

TEST(CheckpointOnRanks, PiecesAnywhereAreTheWhole) {
  expect_same_in_pieces(small_case(), 11, 7);
}

// Copies that fail their CRC, delays by chance, and diverted records, since there are few slots; arrivals that wait.
TEST(CheckpointOnRanks, WhatIsOnItsWayIsSaved) {
  RenderCase render_case = small_case();
  render_case.quality.max_shots = 3;
  render_case.machine.description.jitter = {.seed = 5, .cycles = 64};
  render_case.machine.description.torus.link_error_rate = 0.05;
  render_case.machine.description.records.niu_slots = 48;
  expect_same_in_pieces(render_case, 9, 7);
}

}  // namespace
}  // namespace torolux::test
