// SPDX-License-Identifier: MIT
// A pass: tiles until all light is home; a report of every PE, before which it has sent what it had for the frame
// buffer; the sums of the pass.
#include "host_tools/stages/adaptive_phase.hpp"

#include <algorithm>
#include <utility>

namespace torolux {
namespace {

/// Reads under way: enough that the bus is never idle for the next.
constexpr std::uint64_t kReadsUnderWay = 16;
/// To look at a block are so many entries: the lightness of two colours, and its neighbours.
constexpr std::uint64_t kEntriesOfBlock = 8;

/// Row by row.
std::vector<FrameRead> reads_of(const std::vector<protocol::Tile>& tiles, std::uint32_t width) {
  std::vector<FrameRead> reads;
  for (const protocol::Tile& tile : tiles) {
    for (std::uint32_t row = tile.row; row < std::uint32_t{tile.row} + tile.rows; ++row) {
      const std::uint32_t end = tile.column + std::uint32_t{tile.columns};
      for (std::uint32_t column = tile.column; column < end; column += kMostPixelsRead) {
        reads.push_back({protocol::Plane::colour, row * width + column, std::min(kMostPixelsRead, end - column)});
      }
    }
  }
  return reads;
}

}  // namespace

AdaptivePhase::AdaptivePhase(unsigned pes, const RayTracingSettings& settings, const protocol::CameraView& camera)
    : pes_(pes),
      settings_(settings),
      camera_(camera),
      plan_(settings),
      samples_(std::size_t{settings.width} * settings.height) {}

void AdaptivePhase::start(HostPort& port) {
  enter(port, Step::trace);
}

std::unique_ptr<Phase> AdaptivePhase::phase_for(Step step) {
  if (step == Step::report) return std::make_unique<ReportPhase>(pes_);
  if (step == Step::read) {
    reads_ = reads_of(plan_.tiles(1), settings_.width);
    return nullptr;
  }
  RayTracingSettings settings = settings_;
  settings.pass = plan_.pass();
  const protocol::View view{camera_, settings.pass.first, settings.pass.count, settings.pass.step};
  return std::make_unique<TilePhase>(
      pes_, settings, view,
      ChosenTiles{plan_.tiles(pes_), [this](const protocol::Tile& tile) { note_finished(tile); }});
}

void AdaptivePhase::enter(HostPort& port, Step step) {
  step_ = step;
  phase_ = phase_for(step);
  if (phase_) return phase_->start(port);
  asked_ = answered_ = 0;
  read_more(port);
}

void AdaptivePhase::on_message(HostPort& port, PeNumber source, protocol::MessageKind kind,
                               std::span<const std::byte> contents) {
  if (!phase_) unexpected(source, kind, "reading the frame buffer");
  phase_->on_message(port, source, kind, contents);
  if (phase_->done() && !given_up_) go_on(port);
}

void AdaptivePhase::go_on(HostPort& port) {
  if (step_ == Step::report) return enter(port, Step::read);
  made_ += tracer().made();
  sent_ += tracer().sent();
  enter(port, Step::report);
}

void AdaptivePhase::read_more(HostPort& port) {
  while (asked_ < reads_.size() && asked_ - answered_ < kReadsUnderWay) port.read_pixels(reads_[asked_++]);
}

void AdaptivePhase::on_pixels(HostPort& port, const FrameRead& read, std::span<const PixelSums> sums) {
  if (step_ != Step::read) return Phase::on_pixels(port, read, sums);
  port.work(HostWork::unpack, host_lines(sums.size_bytes()));
  plan_.take(read.first, sums);
  ++answered_;
  if (given_up_) return;
  if (answered_ < reads_.size()) return read_more(port);
  port.work(HostWork::entry, kEntriesOfBlock * plan_.advance());
  if (!plan_.finished()) enter(port, Step::trace);
}

void AdaptivePhase::note_finished(const protocol::Tile& tile) {
  const std::uint32_t samples = plan_.pass().first + plan_.pass().count;
  for (std::uint32_t row = tile.row; row < std::uint32_t{tile.row} + tile.rows; ++row) {
    std::fill_n(samples_.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * settings_.width + tile.column),
                tile.columns, samples);
  }
}

const char* AdaptivePhase::waiting_for() const {
  return phase_ ? phase_->waiting_for() : "sums of the frame buffer";
}

void AdaptivePhase::save(SnapshotWriter& archive) {
  this->archive(archive);
  plan_.archive(archive);
  if (phase_) phase_->save(archive);
}

void AdaptivePhase::restore(SnapshotReader& archive) {
  this->archive(archive);
  plan_.archive(archive);
  if (step_ > Step::read || samples_.size() != std::size_t{settings_.width} * settings_.height)
    refuse_snapshot("the passes over the picture are nowhere");
  phase_ = phase_for(step_);
  if (phase_) phase_->restore(archive);
}

}  // namespace torolux
