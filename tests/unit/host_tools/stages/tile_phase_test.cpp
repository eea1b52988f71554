// SPDX-License-Identifier: MIT
// The host's conduct of the ray tracing stage where PEs make the rays: every pixel is dealt once, no PE has more tiles
// than it has places, no more credits are out than there are, and the stage ends when all has come back.
#include "host_tools/stages/tile_phase.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/unit/host_tools/stages/fake_port.hpp"

namespace torolux::test {
namespace {

using protocol::MessageKind;
using protocol::Tile;

constexpr std::uint32_t kSamples = 3;

/// PEs that make one tile at a time when told to, on credits or not.
class TileMachine {
 public:
  TileMachine(TilePhase& phase, unsigned pes, std::uint32_t width, std::uint32_t height)
      : phase_(phase), port_(pes), width_(width), dealt_(std::size_t{width} * height) {}

  void start() {
    phase_.start(port_);
    take();
  }
  void take() {
    for (const Sent& sent : port_.take()) {
      EXPECT_EQ(sent.record_bytes, 0U) << "the host makes no records";
      if (sent.is(MessageKind::tile)) {
        deal(sent.pe, sent.as<Tile>());
      } else {
        ASSERT_TRUE(sent.is(MessageKind::grant));
        credits_[sent.pe] += sent.as<protocol::Grant>().credits;
      }
    }
  }
  /// One tile of a PE is done; `lost` of its rays missed the object space.
  void finish(PeNumber pe, std::uint32_t lost = 0) {
    const Tile tile = tiles_[pe].front();
    tiles_[pe].pop_front();
    tell(phase_, port_, pe, MessageKind::work_done,
         protocol::WorkDone{1, std::uint32_t{tile.columns} * tile.rows * kSamples - lost});
    take();
  }
  void send_home(PeNumber pe, std::uint32_t most = 1000) {
    const std::uint32_t count = std::min(credits_[pe], most);
    credits_[pe] -= count;
    if (count > 0) tell(phase_, port_, pe, MessageKind::credits, protocol::Credits{count});
    take();
  }
  void need(PeNumber pe) {
    tell(phase_, port_, pe, MessageKind::need);
    take();
  }
  std::uint64_t credits_out() const {
    std::uint64_t sum = 0;
    for (const auto& [pe, count] : credits_) sum += count;
    return sum;
  }
  std::size_t tiles_of(PeNumber pe) { return tiles_[pe].size(); }
  std::uint32_t credits_of(PeNumber pe) { return credits_[pe]; }
  const std::vector<int>& dealt() const { return dealt_; }

 private:
  void deal(PeNumber pe, const Tile& tile) {
    tiles_[pe].push_back(tile);
    EXPECT_LE(tiles_[pe].size(), protocol::kTilePlaces);
    for (std::uint32_t row = tile.row; row < std::uint32_t{tile.row} + tile.rows; ++row) {
      for (std::uint32_t column = tile.column; column < std::uint32_t{tile.column} + tile.columns; ++column) {
        ASSERT_LT(column, width_);
        ++dealt_.at(std::size_t{row} * width_ + column);
      }
    }
  }

  TilePhase& phase_;
  FakePort port_;
  std::uint32_t width_;
  std::vector<int> dealt_;  ///< by pixel
  std::map<PeNumber, std::deque<Tile>> tiles_;
  std::map<PeNumber, std::uint32_t> credits_;
};

TEST(TilePhase, EveryPixelIsDealtOnce) {
  for (const auto& [width, height, pes] :
       {std::array{1U, 1U, 7U}, std::array{97U, 61U, 6U}, std::array{640U, 3U, 2U}, std::array{256U, 256U, 64U}}) {
    TilePhase phase(pes, {1000, width, height, kSamples, {0, kSamples, 1}, true});
    TileMachine machine(phase, pes, width, height);
    machine.start();
    std::uint64_t lost = 0;
    for (bool any = true; any;) {
      any = false;
      for (PeNumber pe = 0; pe < pes; ++pe) {
        if (machine.tiles_of(pe) == 0) continue;
        EXPECT_FALSE(phase.done());
        machine.finish(pe, 1);
        ++lost;
        any = true;
      }
    }
    for (const int count : machine.dealt()) ASSERT_EQ(count, 1) << width << " x " << height;
    EXPECT_EQ(phase.made(), phase.count());
    EXPECT_EQ(phase.sent() + lost, phase.count());
    EXPECT_FALSE(phase.done()) << "credits are out";
    for (PeNumber pe = 0; pe < pes; ++pe) machine.send_home(pe);
    EXPECT_TRUE(phase.done());
  }
}

TEST(TilePhase, WhoIsDoneGetsTheNext) {
  TilePhase phase(4, {100, 64, 64, kSamples, {0, kSamples, 1}, true});
  TileMachine machine(phase, 4, 64, 64);
  machine.start();
  for (PeNumber pe = 0; pe < 4; ++pe) EXPECT_EQ(machine.tiles_of(pe), protocol::kTilePlaces);
  for (int i = 0; i < 20; ++i) {
    machine.finish(2);
    EXPECT_EQ(machine.tiles_of(2), protocol::kTilePlaces) << "though others have not moved";
  }
}

// A view nobody wants any more: what is out comes home, and that is the end.
TEST(TilePhase, GivenUpItDealsNothingMore) {
  const protocol::View view{{}, 1, kSamples, 1};
  TilePhase phase(4, {100, 64, 64, kSamples + 1, {1, kSamples, 1}, true}, view);
  FakePort port(4);
  phase.start(port);
  std::vector<PeNumber> holders;
  std::uint32_t credits = 0;
  const auto sent = port.take();
  ASSERT_TRUE(sent.at(0).is(MessageKind::view)) << "PEs are told of the pass before they get tiles";
  EXPECT_EQ(sent.at(0).pe, protocol::kHost) << "all at once";
  for (const Sent& one : sent) {
    if (one.is(MessageKind::tile)) holders.push_back(one.pe);
    if (one.is(MessageKind::grant)) credits += one.as<protocol::Grant>().credits;
  }
  phase.give_up();
  EXPECT_FALSE(phase.done());
  for (const PeNumber pe : holders) tell(phase, port, pe, MessageKind::work_done, protocol::WorkDone{1, 5});
  EXPECT_TRUE(port.take().empty()) << "no tile is dealt any more";
  EXPECT_FALSE(phase.done()) << "credits are out";
  tell(phase, port, 0, MessageKind::credits, protocol::Credits{credits});
  EXPECT_TRUE(phase.done());
  EXPECT_LT(phase.made(), phase.count());
}

// So the end of the stage is even: at most about a tile's time in that of all tiles of a PE is lost.
TEST(TilePhase, EachPeHasManyTiles) {
  for (const unsigned pes : {1U, 16U, 64U, 256U, 1024U}) {
    for (const std::uint32_t edge : {128U, 256U, 1000U}) {
      const TileGrid grid = tile_grid(edge, edge, 32, pes);
      const std::uint64_t pixels = std::uint64_t{edge} * edge;
      EXPECT_GE(grid.count(), std::min<std::uint64_t>(pixels, std::uint64_t{32} * pes)) << edge << ", " << pes;
      // Few messages: a tile has no fewer pixels than it must, up to squares' being coarse.
      EXPECT_LE(grid.count(), std::max<std::uint64_t>(std::uint64_t{4} * 32 * pes, pixels / 512))
          << edge << ", " << pes;
    }
  }
}

// Tiles of 36 rays in place of 4 with four samples: what the host can deal to a thousand PEs in their time.
TEST(TilePhase, TilesAreNoSmallerThanTheHostCanDeal) {
  EXPECT_EQ(tile_grid(256, 256, 4, 1024).edge, 3U);
  EXPECT_EQ(tile_grid(256, 256, 1, 1024).edge, 4U) << "four for each PE at the least";
  EXPECT_EQ(tile_grid(256, 256, 64, 1024).edge, 1U);
}

TEST(TilePhase, CreditsGoToWhoHasNone) {
  TilePhase phase(3, {12, 64, 64, kSamples, {0, kSamples, 1}, true});
  TileMachine machine(phase, 3, 64, 64);
  machine.start();
  for (PeNumber pe = 0; pe < 3; ++pe) EXPECT_EQ(machine.credits_of(pe), 4U) << "an equal share at first";
  EXPECT_EQ(phase.credits_home(), 0U);
  machine.need(1);
  EXPECT_EQ(machine.credits_of(1), 4U) << "there are none";
  machine.send_home(0);
  EXPECT_EQ(machine.credits_of(1), 6U) << "half a share of what has come home";
  EXPECT_EQ(machine.credits_out() + phase.credits_home(), 12U);
  machine.need(2);
  EXPECT_EQ(machine.credits_of(2), 6U);
  EXPECT_EQ(phase.credits_home(), 0U);
  machine.need(0);
  machine.send_home(1, 1);
  EXPECT_EQ(machine.credits_of(0), 1U) << "no more than there are";
}

TEST(TilePhase, OneCreditIsEnough) {
  TilePhase phase(2, {1, 8, 8, kSamples, {0, kSamples, 1}, true});
  TileMachine machine(phase, 2, 8, 8);
  machine.start();
  EXPECT_EQ(machine.credits_of(0), 1U);
  EXPECT_EQ(machine.credits_of(1), 0U);
  machine.need(1);
  while (machine.tiles_of(0) > 0) machine.finish(0);
  machine.send_home(0);
  EXPECT_EQ(machine.credits_of(1), 1U);
  while (machine.tiles_of(1) > 0) machine.finish(1);
  machine.send_home(1);
  EXPECT_TRUE(phase.done());
}

TEST(TilePhase, MessagesThatCannotBeAreRefused) {
  TilePhase phase(2, {10, 8, 8, kSamples, {0, kSamples, 1}, true});
  FakePort port(2);
  phase.start(port);
  EXPECT_THROW(tell(phase, port, 0, MessageKind::ready), MachineFailure);
  EXPECT_THROW(tell(phase, port, 0, MessageKind::credits), MachineFailure) << "too short";
  EXPECT_THROW(tell(phase, port, 0, MessageKind::credits, protocol::Credits{11}), MachineFailure) << "10 are out";
  EXPECT_THROW(tell(phase, port, 0, MessageKind::work_done, protocol::WorkDone{3, 1}), MachineFailure) << "it had two";
}

}  // namespace
}  // namespace torolux::test
