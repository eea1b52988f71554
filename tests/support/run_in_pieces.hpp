// SPDX-License-Identifier: MIT
// A render that is interrupted again and again, and each time goes on from its checkpoint: a case enters, what it
// leaves in the end, and all of that as text, leave.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host_tools/checkpoint/checkpoint_file.hpp"
#include "tests/support/render_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {

/// All that a render leaves, times of this computer apart; not its picture.
inline std::string everything(const RenderResult& result) {
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

/// Runs a piece of a render, as run_case does the whole; pieces are counted from 0.
using RunPiece = std::function<RenderResult(const RenderCase&, unsigned piece)>;

/// Runs the case in pieces of so many messages to the host, twice as many, thrice, and so on (ever_longer). next:
/// changes the machine before each piece.
inline Pieces run_in_pieces(
    RenderCase render_case, unsigned messages, const std::function<void(RenderCase&, unsigned piece)>& next = {},
    bool ever_longer = true,
    const RunPiece& run_piece = [](const RenderCase& piece, unsigned) { return run_case(piece); }) {
  const testing_support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a.ckpt";
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
      pieces.result = run_piece(render_case, pieces.interruptions);
      return pieces;
    } catch (const StateSaved&) {
      ++pieces.interruptions;
    }
  }
}

}  // namespace torolux::test
