// SPDX-License-Identifier: MIT
// Loading and reading out: images reach PEs whole, and what PEs hold reaches the place in the solution that it belongs
// to. PEs are byte arrays here.
#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "firmware/protocol/store_names.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/stage_image.hpp"
#include "host_tools/stages/load_phase.hpp"
#include "host_tools/stages/read_phase.hpp"
#include "tests/unit/host_tools/stages/fake_port.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux::test {
namespace {

using protocol::LoadBlock;
using protocol::MessageKind;
using protocol::Stage;

constexpr MemoryMap kMap{protocol::kLocalMemoryBase + 100'000, 64};

class LoadReadTest : public testing::Test {
 protected:
  LoadReadTest() {
    for (PeNumber pe = 0; pe < placement_.torus.pes(); ++pe) {
      const PeLayout layout = lay_out(mesh_, placement_, pe, Stage::radiosity, stage_parameters(), kMap);
      loads_.push_back({layout.layout, radiosity_image(scene_, mesh_, placement_, pe, units_, layout)});
    }
  }

  /// What a PE answers to `report`.
  static protocol::Tally tally_of(PeNumber pe) {
    return {{pe, 1, 0}, {3, pe, 0}, {2, 0, 0}, {0, 0, pe * 10}, {7, 7, 7}, {0, 5, 0}, 1000U + pe, 10U + pe};
  }

  /// The PE's bytes from `address` on.
  std::span<std::byte> memory(PeNumber pe, std::uint32_t address) {
    return std::span(loads_[pe].image).subspan(address - loads_[pe].layout.cell_words.address);
  }

  /// Marks each patch side of a PE, and its elements: (PE, number of the side in the store, number in the side).
  void mark(PeNumber pe) {
    const protocol::StageLayout& layout = loads_[pe].layout;
    std::vector<std::uint32_t> first(layout.patch_sides.count + 1, layout.elements.count);
    for (std::uint32_t i = layout.patch_sides.count; i-- > 0;) {
      const auto at =
          memory(pe, layout.patch_sides.address + i * static_cast<std::uint32_t>(sizeof(protocol::PatchSide)));
      protocol::PatchSide side{};
      std::memcpy(&side, at.data(), sizeof side);
      side.shot = {pe, i, -1};
      std::memcpy(at.data(), &side, sizeof side);
      first[i] = side.first_element;
      for (std::uint32_t e = side.first_element; e < first[i + 1]; ++e) {
        protocol::Element element{};
        element.flux = {pe, i, e - side.first_element};
        element.gathered = {i, pe, 1};
        element.points = pe;
        std::memcpy(memory(pe, layout.elements.address + e * static_cast<std::uint32_t>(sizeof element)).data(),
                    &element, sizeof element);
      }
    }
  }

  ReadPhase reading() const {
    std::vector<protocol::StageLayout> layouts;
    for (const PeLoad& load : loads_) layouts.push_back(load.layout);
    return {mesh_, placement_, layouts};
  }

  /// Answers until all is read; PEs in an order by `seed`.
  void answer_all(ReadPhase& phase, std::uint32_t seed) {
    FakePort port(placement_.torus.pes());
    phase.start(port);
    std::minstd_rand random(seed);
    std::vector<Sent> asked = port.take();
    while (!asked.empty()) {
      const std::size_t at = random() % asked.size();
      const Sent question = asked[at];
      asked.erase(asked.begin() + static_cast<std::ptrdiff_t>(at));
      if (question.is(MessageKind::report)) {
        tell(phase, port, question.pe, MessageKind::tally, protocol::StageReport{tally_of(question.pe), {}});
      } else {
        ASSERT_TRUE(question.is(MessageKind::read));
        const auto block = question.as<LoadBlock>();
        EXPECT_LE(block.bytes, protocol::kMostLoadBytes);
        std::vector<std::byte> answer(sizeof block + block.bytes);
        std::memcpy(answer.data(), &block, sizeof block);
        std::memcpy(answer.data() + sizeof block, memory(question.pe, block.address).data(), block.bytes);
        phase.on_message(port, question.pe, MessageKind::data, answer);
      }
      for (Sent& next : port.take()) asked.push_back(std::move(next));
    }
  }

  Scene scene_ = room_with_box();
  Mesh mesh_ = make_mesh(scene_, {.patch_length = 0.4, .element_length = 0.1});
  LightUnits units_ = light_units(scene_, mesh_, false);
  Placement placement_ = make_placement(mesh_, {{3, 2}, std::array<std::uint32_t, 3>{4, 4, 4}, "skewed"});
  std::vector<PeLoad> loads_;
};

/// What PEs have of their stores, each as its layout says.
class LoadedPes {
 public:
  explicit LoadedPes(std::size_t pes) : layouts_(pes), memory_(pes), begun_(pes) {}

  void hear(const Sent& sent) {
    if (sent.pe != protocol::kHost) {
      hear(sent.pe, sent);
      return;
    }
    EXPECT_TRUE(sent.is(MessageKind::load_store)) << "nothing else goes to all";
    ++broadcasts;
    for (PeNumber pe = 0; pe < memory_.size(); ++pe) hear(pe, sent);
  }
  bool begun(PeNumber pe) const { return begun_[pe]; }

  /// All stores but the record slots.
  void expect_all(PeNumber pe, const PeLoad& load) const {
    ASSERT_TRUE(begun_[pe]);
    EXPECT_EQ(memory_[pe], load.image) << "PE " << pe;
  }

  std::uint64_t broadcasts = 0;
  std::uint64_t bytes_to_one = 0;  ///< of stores

 private:
  void hear(PeNumber pe, const Sent& sent) {
    EXPECT_FALSE(begun_[pe]) << "all is there when it begins";
    if (sent.is(MessageKind::configure)) {
      ASSERT_EQ(sent.bytes.size(), sizeof(protocol::StageLayout));
      layouts_[pe] = sent.as<protocol::StageLayout>();
      // Local memory is zero at the beginning of a run, and of any content behind it: elements alone are cleared.
      std::uint64_t end = layouts_[pe].cell_words.address;
      for (const protocol::StoreExtent& extent : protocol::store_extents(layouts_[pe])) {
        if (extent.store.address != layouts_[pe].record_slots.address) end = std::max(end, extent.end());
      }
      memory_[pe].resize((end - layouts_[pe].cell_words.address + 3) / 4 * 4);
    } else if (sent.is(MessageKind::load)) {
      const auto block = sent.as<LoadBlock>();
      bytes_to_one += block.bytes;
      put(pe, block.address, sent.bytes, sizeof block, block.bytes);
    } else if (sent.is(MessageKind::load_store)) {
      const auto block = sent.as<protocol::LoadStore>();
      const protocol::StoreExtent extent = protocol::store_extents(layouts_[pe])[block.store];
      EXPECT_LE(block.offset + block.bytes, (extent.bytes() + 3) / 4 * 4) << "store " << block.store;
      put(pe, extent.store.address + block.offset, sent.bytes, sizeof block, block.bytes);
    } else {
      EXPECT_TRUE(sent.is(MessageKind::begin));
      begun_[pe] = true;
    }
  }
  void put(PeNumber pe, std::uint32_t address, const std::vector<std::byte>& message, std::size_t head,
           std::uint32_t bytes) {
    ASSERT_FALSE(memory_[pe].empty()) << "the layout comes first";
    ASSERT_EQ(message.size(), head + bytes);
    EXPECT_LE(message.size(), protocol::kMostMessageBytes);
    const std::size_t at = address - layouts_[pe].cell_words.address;
    ASSERT_LE(at + bytes, memory_[pe].size());
    std::copy(message.begin() + static_cast<std::ptrdiff_t>(head), message.end(),
              memory_[pe].begin() + static_cast<std::ptrdiff_t>(at));
  }

  std::vector<protocol::StageLayout> layouts_;
  std::vector<std::vector<std::byte>> memory_;  ///< from layout.cell_words.address on
  std::vector<bool> begun_;
};

Loads loads_of(const std::vector<PeLoad>& loads, std::shared_ptr<const PeLoad> common = {}) {
  return {[&loads](PeNumber pe) { return loads[pe].layout; }, [&loads](PeNumber pe) { return loads[pe].image; },
          std::move(common)};
}

TEST_F(LoadReadTest, ImagesReachTheirPesWhole) {
  FakePort port(6);
  LoadPhase phase(6, loads_of(loads_));
  phase.start(port);
  LoadedPes pes(6);
  for (const Sent& sent : port.take()) pes.hear(sent);
  EXPECT_EQ(pes.broadcasts, 0U);
  for (PeNumber pe = 0; pe < 6; ++pe) {
    pes.expect_all(pe, loads_[pe]);
    EXPECT_FALSE(phase.done());
    tell(phase, port, pe, MessageKind::ready);
  }
  EXPECT_TRUE(phase.done());
  EXPECT_THROW(tell(phase, port, 0, MessageKind::tally), MachineFailure);
}

// With copies of all subspaces most of it is alike on all PEs, and goes to all at once; what is left is what differs.
TEST_F(LoadReadTest, WhatAllHaveIsSentOnce) {
  const Grid grid = make_grid(mesh_.space, std::array<std::uint32_t, 3>{4, 4, 4}, mesh_.triangles.size(), 6);
  enum class Copies { none, some, all };
  for (const Copies copies : {Copies::none, Copies::some, Copies::all}) {
    std::vector<bool> common_cell(grid.count(), copies == Copies::all);
    for (CellIndex cell = 0; copies == Copies::some && cell < grid.count(); cell += 2) common_cell[cell] = true;
    const Placement placement =
        make_placement(mesh_, list_cells(mesh_, grid),
                       {.torus = {3, 2}, .subspaces = {}, .allocation = "balanced", .scheme = Scheme::spread},
                       {.common_cell = common_cell});
    const auto load = [&](const Placement& of, PeNumber pe, const PeLoad* common) {
      const PeLayout layout = lay_out(mesh_, of, pe, Stage::radiosity, stage_parameters(), kMap);
      return PeLoad{layout.layout, radiosity_image(scene_, mesh_, of, pe, units_, layout, common)};
    };
    const auto common = std::make_shared<const PeLoad>(load(placement.with_nobody(), 6, nullptr));
    std::vector<PeLoad> loads;
    std::uint64_t all = 0;
    for (PeNumber pe = 0; pe < 6; ++pe) {
      loads.push_back(load(placement, pe, nullptr));
      EXPECT_EQ(load(placement, pe, common.get()).image, loads.back().image) << "begun with what all have";
      all += loads.back().image.size() - loads.back().layout.elements.count * sizeof(protocol::Element);
    }
    FakePort port(6);
    LoadPhase phase(6, loads_of(loads, common));
    phase.start(port);
    LoadedPes pes(6);
    for (const Sent& sent : port.take()) pes.hear(sent);
    for (PeNumber pe = 0; pe < 6; ++pe) pes.expect_all(pe, loads[pe]);
    EXPECT_GT(pes.broadcasts, 0U);
    // Messages have heads.
    const auto differs = static_cast<double>(all - 6 * common->image.size());
    EXPECT_LT(static_cast<double>(pes.bytes_to_one), 1.05 * differs);
    EXPECT_LT(differs, (copies == Copies::all ? 0.8 : 1) * static_cast<double>(all));
  }
}

TEST_F(LoadReadTest, LayingOutCostsTheHostByTheByte) {
  FakePort port(6);
  LoadPhase phase(6, loads_of(loads_));
  phase.start(port);
  std::uint64_t least = 0;
  std::uint64_t most = 0;
  for (const Sent& sent : port.take()) {
    if (sent.is(MessageKind::configure)) least += sent.bytes.size();
    if (sent.is(MessageKind::load)) least += sent.bytes.size() - sizeof(LoadBlock);
  }
  for (const PeLoad& load : loads_) most += sizeof load.layout + load.image.size();
  EXPECT_GE(port.done(HostWork::layout), least / 64);
  // Each store ends in a line of its own.
  EXPECT_LE(port.done(HostWork::layout), most / 64 + 6U * (protocol::kStores + 1U));
}

TEST_F(LoadReadTest, ImagesAreMadeAsPesBecomeReady) {
  constexpr unsigned kPes = 300;
  unsigned made = 0;
  FakePort port(kPes);
  LoadPhase phase(kPes, {[&](PeNumber) { return loads_[0].layout; },
                         [&](PeNumber pe) {
                           EXPECT_EQ(pe, made++);
                           return loads_[0].image;
                         },
                         {}});
  phase.start(port);
  EXPECT_LT(made, 100U) << "not all images at once";
  for (unsigned pe = 0; pe < kPes; ++pe) {
    EXPECT_GT(made, pe) << "a PE that is not loaded cannot be ready";
    tell(phase, port, static_cast<PeNumber>(pe), MessageKind::ready);
  }
  EXPECT_EQ(made, kPes);
  EXPECT_TRUE(phase.done());
}

TEST_F(LoadReadTest, SidesAndElementsFindTheirGlobalPlaces) {
  for (PeNumber pe = 0; pe < 6; ++pe) mark(pe);
  for (const std::uint32_t seed : {1U, 2U}) {
    ReadPhase phase = reading();
    answer_all(phase, seed);
    ASSERT_TRUE(phase.done());
    const Solution solution = phase.take_solution();
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
      const MeshPatch& patch = mesh_.patches[p];
      for (std::uint32_t s = 0; s < 2; ++s) {
        if (patch.side[s] == protocol::kNoSide) continue;
        const SolvedSide& side = solution.sides[patch.side[s]];
        EXPECT_EQ(side.shot[0], placement_.patch_home[p].pe) << "read from its owner";
        EXPECT_EQ(side.emission, patch_emission(scene_, patch, s, units_)) << "this side and no other";
        for (std::uint32_t e = 0; e < patch.elements; ++e) {
          const SolvedElement& element = solution.elements[patch.first_element[s] + e];
          ASSERT_EQ(element.flux, (protocol::Flux{side.shot[0], side.shot[1], e}));
          ASSERT_EQ(element.points, side.shot[0]);
          const protocol::Flux gathered{side.shot[1], side.shot[0], 1};
          ASSERT_EQ(element.gathered, element.points > 0 ? gathered : protocol::Flux{}) << "else it is another's room";
        }
      }
    }
  }
}

TEST_F(LoadReadTest, TalliesAreAddedUp) {
  ReadPhase phase = reading();
  answer_all(phase, 3);
  const protocol::Tally tally = phase.take_solution().tally;
  EXPECT_EQ(tally.absorbed_specular, (protocol::Flux{15, 6, 0}));
  EXPECT_EQ(tally.reflected_glossy, (protocol::Flux{18, 15, 0}));
  EXPECT_EQ(tally.escaped, (protocol::Flux{12, 0, 0}));
  EXPECT_EQ(tally.cut_off, (protocol::Flux{0, 0, 150}));
  EXPECT_EQ(tally.back_side, (protocol::Flux{42, 42, 42}));
  EXPECT_EQ(tally.sky_rest, (protocol::Flux{0, 30, 0}));
  EXPECT_EQ(tally.rays, 6015U);
  EXPECT_EQ(tally.gather_rays, 75U);
}

TEST_F(LoadReadTest, AnswersThatWereNotAskedForAreRefused) {
  ReadPhase phase = reading();
  FakePort port(6);
  phase.start(port);
  auto block = port.take().at(0).as<LoadBlock>();
  EXPECT_THROW(tell(phase, port, 0, MessageKind::data, block), MachineFailure) << "without its bytes";
  std::vector<std::byte> answer(sizeof block + block.bytes);
  block.address += 4;
  std::memcpy(answer.data(), &block, sizeof block);
  EXPECT_THROW(phase.on_message(port, 0, MessageKind::data, answer), MachineFailure) << "another address";
  EXPECT_THROW(tell(phase, port, 0, MessageKind::tally), MachineFailure) << "too short";
  EXPECT_THROW(tell(phase, port, 0, MessageKind::credits, protocol::Credits{1}), MachineFailure);
}

}  // namespace
}  // namespace torolux::test
