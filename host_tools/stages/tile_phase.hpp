// SPDX-License-Identifier: MIT
// The ray tracing stage where PEs make the camera rays: the host deals tiles of the picture to whoever has little left,
// and credits to whoever has none.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "host_tools/stages/credit_pool.hpp"
#include "host_tools/stages/ray_phase.hpp"

namespace torolux {

/// Squares that cover a picture; those at the right and at the bottom are cut off.
struct TileGrid {
  std::uint32_t width, height;  ///< of the picture [pixels]
  std::uint32_t edge;           ///< [pixels]

  std::uint32_t columns() const { return (width + edge - 1) / edge; }
  std::uint64_t count() const { return std::uint64_t{columns()} * ((height + edge - 1) / edge); }
  protocol::Tile tile(std::uint64_t number) const;
};

/// Tiles small enough that at the end all PEs are done at about the same time, large enough for the host.
TileGrid tile_grid(std::uint32_t width, std::uint32_t height, std::uint32_t samples, unsigned pes);

/// Those of a part of the picture, in place of a grid's.
struct ChosenTiles {
  std::vector<protocol::Tile> tiles;                         ///< 1 or more
  std::function<void(const protocol::Tile&)> finished = {};  ///< all rays of it have been made
};

class TilePhase : public RayPhase {
 public:
  /// view: the PEs are told of it first. Without: they make the rays that their stores say.
  TilePhase(unsigned pes, const RayTracingSettings& settings, const std::optional<protocol::View>& view = {});
  TilePhase(unsigned pes, const RayTracingSettings& settings, const protocol::View& view, ChosenTiles chosen);

  void start(HostPort& port) override;
  void on_message(HostPort& port, PeNumber source, protocol::MessageKind kind,
                  std::span<const std::byte> contents) override;
  bool done() const override { return next_ == end_ && under_way_ == 0 && credits_.all_home(); }
  const char* waiting_for() const override { return "tiles and credits"; }
  void save(SnapshotWriter& archive) override { this->archive(archive); }
  void restore(SnapshotReader& archive) override { this->archive(archive); }

  std::uint64_t made() const override { return made_; }
  std::uint64_t count() const override { return pixels_ * settings_.pass.count; }
  std::uint64_t sent() const override { return sent_; }
  std::uint64_t credits_home() const override { return credits_.home(); }
  void give_up() override { end_ = next_; }

 private:
  template <class Archive>
  void archive(Archive& archive) {
    archive(next_, held_, under_way_, credits_, made_, sent_);
  }

  protocol::Tile tile_in_turn(std::uint64_t turn) const;
  void deal(HostPort& port, PeNumber pe);
  void take_work_done(HostPort& port, PeNumber source, const protocol::WorkDone& done);

  unsigned pes_;
  RayTracingSettings settings_;
  std::optional<protocol::View> view_;
  TileGrid grid_;
  ChosenTiles chosen_;   ///< none: the grid's
  std::uint64_t tiles_;  ///< of the pass
  std::uint64_t pixels_;
  std::uint64_t step_;                           ///< of the order in which tiles are dealt
  std::uint64_t next_ = 0;                       ///< in that order
  std::uint64_t end_;                            ///< in that order: the first that is not dealt
  std::vector<std::deque<std::uint64_t>> held_;  ///< tiles that a PE has been dealt and not finished, by that order
  std::uint64_t under_way_ = 0;                  ///< of those tiles, in all
  CreditPool credits_;
  std::uint64_t made_ = 0;
  std::uint64_t sent_ = 0;
};

}  // namespace torolux
