// SPDX-License-Identifier: MIT
// A render that is interrupted again and again, and goes on each time, ends as one that never was: picture, cycles, all
// figures. What is saved in between has every kind of moment in it.
#include <gtest/gtest.h>

#include <algorithm>

#include "host_tools/scene/keep_on.hpp"
#include "tests/physics/same_picture.hpp"
#include "tests/support/run_in_pieces.hpp"

namespace torolux::test {
namespace {

RenderCase small_case() {
  RenderCase render_case = small_cornell();
  render_case.machine.engine = "translated";
  render_case.machine.threads = 1;
  render_case.quality.max_shots = 12;
  return render_case;
}

void expect_same_in_pieces(const RenderCase& render_case, unsigned messages, unsigned least_pieces) {
  const RenderResult whole = run_case(render_case);
  const Pieces pieces = run_in_pieces(render_case, messages);
  EXPECT_GE(pieces.interruptions, least_pieces);
  EXPECT_EQ(everything(pieces.result), everything(whole));
  EXPECT_EQ(bytes_of(pieces.result.picture), bytes_of(whole.picture));
}

TEST(Checkpoint, PiecesAreTheWhole) {
  expect_same_in_pieces(small_case(), 11, 5);
}

// Ctrl-C while rays are traced: the picture as far as it is, ever more of it.
TEST(Checkpoint, ThePictureSoFarIsKept) {
  RenderCase render_case = small_case();
  render_case.quality.max_shots = 1;
  render_case.quality.width = render_case.quality.height = 64;
  const Pieces pieces = run_in_pieces(render_case, 50, {}, false);
  ASSERT_GE(pieces.lit.size(), 2U);
  EXPECT_LT(pieces.lit.front(), pieces.lit.back());
  EXPECT_TRUE(std::ranges::is_sorted(pieces.lit));
  EXPECT_LE(pieces.lit.back(), pieces.result.picture.pixels.size());
}

// Drafts, their halves, and the splits between them; layers; two threads.
TEST(Checkpoint, DraftsGoOn) {
  RenderCase render_case = small_case();
  render_case.quality.refine = 1;
  render_case.quality.layers = protocol::plane_bit(protocol::Plane::depth);
  render_case.machine.threads = 2;
  expect_same_in_pieces(render_case, 53, 5);
}

bool told_to_end = false;

// Ctrl-C while the mesh of the next machine is made: drafts that are done are not lost, the machine saves them.
TEST(Checkpoint, NoMeshBetweenMachinesIsGivenUp) {
  const testing_support::TemporaryFolder folder;
  RenderCase render_case = small_case();
  render_case.quality.refine = 1;
  render_case.files.checkpoint.file = folder.path() / "a.ckpt";
  render_case.files.checkpoint.minutes = 0;
  render_case.files.checkpoint.interrupted = [] {
    told_to_end = true;
    return false;
  };
  set_interruption([] { return told_to_end; });
  EXPECT_NO_THROW(run_case(render_case));
  EXPECT_TRUE(told_to_end) << "the test is to reach its end with that";
  set_interruption(nullptr);
}

// Copies that fail their CRC, and delays by chance, in a torus that is not a square; diverted records, since there are
// few slots.
TEST(Checkpoint, WhatIsOnItsWayIsSaved) {
  RenderCase render_case = small_case();
  render_case.machine.columns = 3;
  render_case.machine.description.jitter = {.seed = 5, .cycles = 64};
  render_case.machine.description.torus.link_error_rate = 0.05;
  render_case.machine.description.records.niu_slots = 48;
  expect_same_in_pieces(render_case, 17, 5);
}

TEST(Checkpoint, RaysOfTheHostGoOn) {
  RenderCase render_case = small_case();
  take_scheme(render_case.machine, Scheme::paper);
  expect_same_in_pieces(render_case, 61, 5);
}

// Passes over the picture, the reading of its sums between them, and how many samples each pixel has.
TEST(Checkpoint, AdaptiveSamplesGoOn) {
  RenderCase render_case = small_case();
  render_case.quality.max_shots = 2;
  render_case.quality.width = render_case.quality.height = 48;
  render_case.quality.samples = 2;
  render_case.quality.most_samples = 8;
  expect_same_in_pieces(render_case, 37, 8);
}

// Each engine goes on where another has stopped.
TEST(Checkpoint, EnginesTakeTurns) {
  RenderCase render_case = small_case();
  render_case.quality.max_shots = 3;
  render_case.quality.emission_records = 5000;
  render_case.quality.width = render_case.quality.height = 8;
  const RenderResult whole = run_case(render_case);
  const Pieces pieces = run_in_pieces(render_case, 13, [](RenderCase& piece, unsigned number) {
    piece.machine.engine = number % 2 == 0 ? "interpreted" : "translated";
  });
  EXPECT_GE(pieces.interruptions, 3U);
  EXPECT_EQ(everything(pieces.result), everything(whole));
}

}  // namespace
}  // namespace torolux::test
