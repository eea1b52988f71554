// SPDX-License-Identifier: MIT
// A render that is interrupted again and again, and goes on each time, ends as one that never was: picture, cycles, all
// figures. What is saved in between has every kind of moment in it.
#include "host_tools/checkpoint/checkpoint_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "emulator/errors.hpp"
#include "tests/physics/same_picture.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

RenderCase small_case() {
  RenderCase render_case = small_cornell();
  render_case.machine.engine = "translated";
  render_case.machine.threads = 1;
  render_case.quality.max_shots = 12;
  return render_case;
}

std::string everything(const RenderResult& result) {
  std::string text = exact_figures(result.figures) + " " + result.figures.picture_sha256 + " drafts " +
                     std::to_string(result.figures.draft_cycles) + " " + std::to_string(result.figures.draft_records) +
                     " splits " + std::to_string(result.figures.splits);
  for (const std::string& layer : result.figures.layers_sha256) text += " " + layer;
  const auto add = [&text](const MachineFigures& figures) {
    text += " bus " + std::to_string(figures.bus.busy_cycles()) + " host " + std::to_string(figures.host.busy_cycles) +
            " retries " + std::to_string(figures.link_retries) + " latency " +
            std::to_string(figures.packets.latency_sum) + " fbc " + std::to_string(figures.frame_buffer_message_cycles);
    for (const KindFigures& kind : figures.record_kinds)
      text += " " + std::to_string(kind.packets) + "/" + std::to_string(kind.records);
    for (const PeFigures& pe : figures.pes) {
      for (const Cycles cycles : pe.waits) text += " " + std::to_string(cycles);
      text += " " + std::to_string(pe.copy_in_cycles) + " " + std::to_string(pe.receive_buffers_high_water);
    }
  };
  add(result.figures.machine);
  for (const StageFigures& stage : result.figures.machine.stages) {
    text += "\n" + stage.name + " " + std::to_string(stage.begin);
    add(stage.figures);
  }
  for (const TimeSlice& slice : result.figures.machine.time_line.slices)
    text += " " + std::to_string(slice.load) + " " + std::to_string(slice.gauges[0]) + " " +
            std::to_string(slice.gauges[1]) + " " + std::to_string(slice.packets);
  for (const RoundFigures& round : result.figures.rounds) text += " " + std::to_string(round.end);
  return text;
}

struct Pieces {
  RenderResult result;
  unsigned interruptions = 0;
  std::vector<std::size_t> lit;  // pixels that were not black, of each picture that was kept
};

/// Runs the case in pieces of so many messages to the host, twice as many, thrice, and so on (ever_longer). next:
/// changes the machine before each piece.
Pieces run_in_pieces(RenderCase render_case, unsigned messages,
                     const std::function<void(RenderCase&, unsigned piece)>& next = {}, bool ever_longer = true) {
  const testing_support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "checkpoint";
  Pieces pieces;
  for (;;) {
    unsigned read = 0;
    render_case.files.checkpoint.file = file;
    render_case.files.checkpoint.minutes = 0;
    render_case.files.checkpoint.interrupted =
        [&read, length = messages * (ever_longer ? pieces.interruptions + 1 : 1)] { return ++read > length; };
    render_case.files.picture_so_far = [&pieces](const Picture& picture) {
      pieces.lit.push_back(static_cast<std::size_t>(
          std::ranges::count_if(picture.pixels, [](const auto& pixel) { return pixel[0] + pixel[1] + pixel[2] > 0; })));
    };
    const auto from = pieces.interruptions != 0 ? std::make_unique<CheckpointReader>(file) : nullptr;
    render_case.files.resume = from.get();
    if (next) next(render_case, pieces.interruptions);
    try {
      pieces.result = run_case(render_case);
      return pieces;
    } catch (const StateSaved&) {
      ++pieces.interruptions;
    }
  }
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
