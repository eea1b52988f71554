// SPDX-License-Identifier: MIT
// Picture, samples and PEs decide the tiles' size. Each PE gets two, and one more for each that is done, in an order in
// which neighbours lie far apart.
#include "host_tools/stages/tile_phase.hpp"

#include <algorithm>
#include <utility>

namespace torolux {
namespace {

using protocol::MessageKind;

/// Tiles that a PE has at a time: while the next one is on its way, it works on the other.
constexpr std::uint32_t kSupply = 2;
static_assert(kSupply <= protocol::kTilePlaces);
/// At the end a PE may wait for about one tile of another's: so each has many of them.
constexpr std::uint64_t kTilesOfPe = 32;
/// But not so small that the host, which needs some hundred cycles for each, cannot supply a thousand PEs, which need
/// about ten thousand for a ray; as long as there are a few for each PE.
constexpr std::uint64_t kRaysOfTile = 32;
constexpr std::uint64_t kLeastTilesOfPe = 4;
/// Larger ones spare nothing worth having.
constexpr std::uint32_t kMostTileEdge = 32;

std::uint64_t pixels_of(const protocol::Tile& tile) {
  return std::uint64_t{tile.columns} * tile.rows;
}

}  // namespace

protocol::Tile TileGrid::tile(std::uint64_t number) const {
  const auto column = static_cast<std::uint32_t>(number % columns()) * edge;
  const auto row = static_cast<std::uint32_t>(number / columns()) * edge;
  return {static_cast<std::uint16_t>(column), static_cast<std::uint16_t>(row),
          static_cast<std::uint16_t>(std::min(edge, width - column)),
          static_cast<std::uint16_t>(std::min(edge, height - row))};
}

TileGrid tile_grid(std::uint32_t width, std::uint32_t height, std::uint32_t samples, unsigned pes) {
  const std::uint64_t pixels = std::uint64_t{width} * height;
  std::uint64_t edge = 1;
  const auto one_more_leaves = [&edge, pixels, pes](std::uint64_t tiles) {
    return (edge + 1) * (edge + 1) * tiles * pes <= pixels;
  };
  while (edge < kMostTileEdge && one_more_leaves(kTilesOfPe)) ++edge;
  while (edge * edge * samples < kRaysOfTile && one_more_leaves(kLeastTilesOfPe)) ++edge;
  return {width, height, static_cast<std::uint32_t>(edge)};
}

TilePhase::TilePhase(unsigned pes, const RayTracingSettings& settings, const std::optional<protocol::View>& view)
    : pes_(pes),
      settings_(settings),
      view_(view),
      grid_(tile_grid(settings.width, settings.height, settings.pass.count, pes)),
      tiles_(grid_.count()),
      pixels_(std::uint64_t{settings.width} * settings.height),
      step_(golden_step(tiles_)),
      end_(tiles_),
      held_(pes),
      credits_(settings.credits, pes) {}

TilePhase::TilePhase(unsigned pes, const RayTracingSettings& settings, const protocol::View& view, ChosenTiles chosen)
    : TilePhase(pes, settings, view) {
  chosen_ = std::move(chosen);
  tiles_ = chosen_.tiles.size();
  pixels_ = 0;
  for (const protocol::Tile& tile : chosen_.tiles) pixels_ += pixels_of(tile);
  step_ = golden_step(tiles_);
  end_ = tiles_;
}

void TilePhase::start(HostPort& port) {
  if (view_) port.broadcast(static_cast<std::uint16_t>(MessageKind::view), std::as_bytes(std::span(&*view_, 1)));
  for (std::uint32_t i = 0; i < kSupply; ++i) {
    for (unsigned pe = 0; pe < pes_; ++pe) deal(port, static_cast<PeNumber>(pe));
  }
  for (unsigned pe = 0; pe < pes_; ++pe) {
    if (!held_[pe].empty()) credits_.grant_share(port, static_cast<PeNumber>(pe));
  }
  credits_.note(port);
}

void TilePhase::on_message(HostPort& port, PeNumber source, MessageKind kind, std::span<const std::byte> contents) {
  if (kind == MessageKind::credits) {
    credits_.take_home(port, source, contents);
    credits_.feed(port);
  } else if (kind == MessageKind::need) {
    credits_.ask(port, source);
  } else if (kind == MessageKind::work_done) {
    take_work_done(port, source, contents_as<protocol::WorkDone>(source, contents));
  } else {
    unexpected(source, kind, "tracing rays");
  }
}

protocol::Tile TilePhase::tile_in_turn(std::uint64_t turn) const {
  const std::uint64_t number = turn * step_ % tiles_;
  return chosen_.tiles.empty() ? grid_.tile(number) : chosen_.tiles[number];
}

/// The next tile, if there is one.
void TilePhase::deal(HostPort& port, PeNumber pe) {
  if (next_ == end_) return;
  port.work(HostWork::entry, 1);
  held_[pe].push_back(next_);
  ++under_way_;
  torolux::send(port, pe, MessageKind::tile, tile_in_turn(next_++));
}

void TilePhase::take_work_done(HostPort& port, PeNumber source, const protocol::WorkDone& done) {
  std::deque<std::uint64_t>& held = held_[source];
  if (done.points > held.size()) {
    throw MachineFailure("PE " + std::to_string(source) + " has done more tiles than it was dealt");
  }
  sent_ += done.records;
  under_way_ -= done.points;
  for (std::uint32_t i = 0; i < done.points; ++i) {
    const protocol::Tile tile = tile_in_turn(held.front());
    held.pop_front();
    made_ += pixels_of(tile) * settings_.pass.count;
    if (chosen_.finished) chosen_.finished(tile);
    deal(port, source);
  }
}

}  // namespace torolux
