// SPDX-License-Identifier: MIT
// Proves: layouts and stores that do not hold end the run with the right code.
#include "firmware/protocol/triangle_grid.hpp"
#include "tests/unit/firmware/pe/malformed.hpp"

namespace torolux::test {
namespace {

TEST(Malformed, LayoutsThatDoNotHoldAreRefused) {
  const TestScene scene = small_scene();
  const std::vector<std::function<void(StageLayout&)>> changes = {
      [](StageLayout& l) { l.stage = Stage{3}; },
      [](StageLayout& l) { l.cells[1] = 0; },
      [](StageLayout& l) { l.cell_size[2] = -1; },
      [](StageLayout& l) { l.polygons.address = protocol::kLocalMemoryBase; },
      [](StageLayout& l) { l.polygons.address += 4; },
      [](StageLayout& l) { l.elements.count = 0x7FFF'FFFF; },
      [](StageLayout& l) { l.elements.address = 0xFFFF'FFF8; },
      [](StageLayout& l) { l.record_slots.address = l.elements.address; },
      [](StageLayout& l) { l.record_slots.count = l.own_slots; },
      [](StageLayout& l) { l.record_slots.count = 0x10'0000; },
      [](StageLayout& l) { l.own_slots -= 1; },
      [](StageLayout& l) { l.open_batches = 0; },
      [](StageLayout& l) {
        l.open_batches = 24;
        l.own_slots = protocol::own_slots(l.stage, 24);
      },
      [](StageLayout& l) {
        l.open_batches = 2 * protocol::kMostOpenBatches;
        l.own_slots = protocol::own_slots(l.stage, l.open_batches);
      },
      [](StageLayout& l) { l.cells[0] = protocol::kMostCellsPerAxis + 1; },
      [](StageLayout& l) { l.cell_words.address = l.cell_entries.address; },
      [](StageLayout& l) { l.credits_kept = 0; },
      [](StageLayout& l) { l.bounces = 0; },
      [](StageLayout& l) { l.bounces = 256; },
      [](StageLayout& l) { l.hemicube_size = 5; },
      [](StageLayout& l) { l.hemicube.count -= 1; },
      [](StageLayout& l) { l.shot_points = 0; },
      [](StageLayout& l) { l.shot_points = protocol::kMostShotPoints + 1; },
      [](StageLayout& l) { l.emission_points = protocol::kMostEmissionPoints + 1; },
      [](StageLayout& l) { l.points_per_quantum = 0; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    FakeMachine machine(1);
    machine.begin(scene, Stage::radiosity);
    StageLayout layout = machine.stores[0].layout;
    EXPECT_EQ(fault_of([&] {
                machine.message(0, MessageKind::configure, layout);
                machine.run();
              }),
              0U);
    changes[i](layout);
    EXPECT_EQ(fault_of([&] {
                machine.message(0, MessageKind::configure, layout);
                machine.run();
              }),
              code(FaultCode::bad_layout))
        << "change " << i;
  }
}

// What elements keep apart: an emitter's own light, turned light, or both; nothing else, and not nothing.
TEST(Malformed, FluxKeptApartIsOneOfThree) {
  constexpr std::uint32_t kDirect = protocol::kDirect;
  constexpr std::uint32_t kTurned = protocol::kTurned;
  for (const std::uint32_t flags : {kDirect, kTurned, kDirect | kTurned, 0U, std::uint32_t{protocol::kFirst},
                                    kTurned | protocol::kGoesOn, kDirect | 0x100U, 0xFFFF'FFFFU}) {
    TestScene scene = small_scene();
    scene.apart = flags;
    FakeMachine machine(1);
    const protocol::Fault fault = whole_fault_of([&] { machine.begin(scene, Stage::radiosity); });
    if (flags != 0 && (flags & ~(kDirect | kTurned)) == 0) {
      expect_none(fault, std::to_string(flags));
    } else {
      expect_fault(fault, FaultCode::bad_layout, protocol::LayoutField::apart, std::to_string(flags));
      EXPECT_EQ(fault.detail[1], flags);
    }
  }
}

// They say which shots are kept apart, where there is final gathering.
TEST(Malformed, DenseShotsAndMeanRadiosityAreFiniteAndAboveZero) {
  const auto fault = [](std::uint32_t apart, float dense_shot, float mean_radiosity) {
    TestScene scene = small_scene();
    scene.apart = apart;
    scene.dense_shot = dense_shot;
    scene.mean_radiosity = mean_radiosity;
    FakeMachine machine(1);
    return whole_fault_of([&] { machine.begin(scene, Stage::radiosity); });
  };
  expect_none(fault(protocol::kTurned, 1, 1), "both are");
  for (const float bad :
       {0.0F, -1.0F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    const std::string what = std::to_string(bad);
    expect_fault(fault(protocol::kTurned, bad, 1), FaultCode::bad_layout, protocol::LayoutField::dense_shot, what);
    expect_fault(fault(protocol::kTurned, 1, bad), FaultCode::bad_layout, protocol::LayoutField::mean_radiosity, what);
    expect_none(fault(protocol::kDirect, bad, bad), what);
  }
}

// Gathering divides by the area where light comes to an element.
TEST(Malformed, LitAreasAreNeitherTooSmallNorTooLarge) {
  const auto fault = [](float area) {
    FakeMachine machine(1);
    TestScene scene = small_scene();
    scene.apart = protocol::kTurned;
    machine.load(scene, Stage::radiosity, 64, 1, [area](PeStores& s) { s.facets[5].lit_area = area; });
    return whole_fault_of([&] {
      machine.message(0, MessageKind::begin);
      machine.run();
    });
  };
  for (const float area : {protocol::kLeastLitArea, 1.0F, protocol::kMostLitArea})
    expect_none(fault(area), std::to_string(area));
  for (const float area : {0.0F, -1.0F, 0x1p-61F, 4.5F, std::numeric_limits<float>::infinity(),
                           std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN()}) {
    expect_fault(fault(area), FaultCode::outside_store, protocol::StoreIndex::lit_area, std::to_string(area));
  }
}

TEST(Malformed, LayersThatThereAreNotAreRefused) {
  TestScene scene = small_scene();
  for (const std::uint32_t layers : {0U, (1U << protocol::kPlanes) - 2U, 1U << protocol::kPlanes}) {
    scene.layers = layers;
    FakeMachine machine(1);
    EXPECT_EQ(fault_of([&] { machine.begin(scene, Stage::ray_tracing); }),
              layers >> protocol::kPlanes == 0 ? 0U : code(FaultCode::bad_layout));
  }
}

TEST(Malformed, CornersAtTheEdgeOfTheUnitCubeAreAccepted) {
  for (const float x : {-0.0F, -0x1p-20F, 1.0F + 0x1p-20F}) {
    FakeMachine machine(1);
    machine.load(small_scene(), Stage::radiosity, 64, 1, [x](PeStores& s) { s.polygons[0].corner[1][1] = x; });
    EXPECT_EQ(fault_of([&] {
                machine.message(0, MessageKind::begin);
                machine.run();
              }),
              0U)
        << x;
  }
}

TEST(Malformed, IndicesThatLeaveTheirStoresAreRefused) {
  const std::vector<std::function<void(PeStores&)>> changes = {
      [](PeStores& s) { s.subspaces[3].polygon_count = 0xFFFF'FFFF; },
      [](PeStores& s) { s.polygon_list[0].polygon = 0xFFFF; },
      [](PeStores& s) { s.polygon_list[0].polygon = protocol::kGroup; },
      [](PeStores& s) { s.polygon_list[0].polygon = protocol::kGroup | s.subspaces[0].polygon_count; },
      [](PeStores& s) { s.polygon_list[0].polygon = protocol::kGroup | 1U; },
      [](PeStores& s) { s.polygon_list[1].polygon = protocol::kGroup | 1U; },
      [](PeStores& s) { s.polygons[0].corner[1][1] = std::numeric_limits<float>::quiet_NaN(); },
      [](PeStores& s) { s.polygons[0].corner[1][1] = 1.5F; },
      [](PeStores& s) { s.polygons[0].corner[1][1] = -0x1p-19F; },
      [](PeStores& s) { s.polygons[0].corner[1][1] = -std::numeric_limits<float>::quiet_NaN(); },
      [](PeStores& s) { s.polygons[0].corner[1][1] = -std::numeric_limits<float>::infinity(); },
      [](PeStores& s) { s.polygons[2].material = 3; },
      [](PeStores& s) { s.polygons[2].normals = 0; },
      [](PeStores& s) { s.polygons[2].patch_level = 11; },
      [](PeStores& s) { s.polygons[2].surface = 0xFFFF'FFFF; },
      [](PeStores& s) { s.polygons[2].sides = 3; },
      [](PeStores& s) { s.materials[1].kind = protocol::MaterialKind{9}; },
      [](PeStores& s) { s.materials[1].kind = protocol::MaterialKind::glossy; },
      [](PeStores& s) { s.references[1].part = 999; },
      [](PeStores& s) { s.references[1].levels = protocol::kMostLevels + 1; },
      [](PeStores& s) { s.parts[1].patch = 999; },
      [](PeStores& s) { s.parts[1].tree = protocol::kLeaf | 4U; },
      [](PeStores& s) { s.parts[1].tree = 0x1000; },
      [](PeStores& s) { s.nodes[0] = 0; },  // a child that is its own parent
      [](PeStores& s) { s.nodes[2] = protocol::kLeaf | 4U; },
      [](PeStores& s) { s.references[1].pe = 4; },
      [](PeStores& s) { s.patches[1].facets = 0; },
      [](PeStores& s) { s.patches[1].first_facet = 0xFFFF'FFFF; },
      [](PeStores& s) { s.patches[1].elements = 3; },
      [](PeStores& s) { s.facets[5].polygon = 0xFFFF'FFFF; },
      [](PeStores& s) { s.facets[5].code = 0; },
      [](PeStores& s) { s.facets[5].code = 0xFFFF'FFFF; },
      [](PeStores& s) { s.facets[5].element = 4; },
      [](PeStores& s) { s.facets[5].of_patch = 0; },
      [](PeStores& s) { s.facets[5].of_element = std::numeric_limits<float>::quiet_NaN(); },
      [](PeStores& s) { s.patches[1].side[0] = 0x1000'0000; },
      [](PeStores& s) { s.sides[0].first_element = static_cast<std::uint32_t>(s.elements.size()) - 3; },
      [](PeStores& s) { s.hemicube[0].weight += 1; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    FakeMachine machine(1);
    machine.load(small_scene(), Stage::radiosity, 64, 1, changes[i]);
    EXPECT_EQ(fault_of([&] {
                machine.message(0, MessageKind::begin);
                machine.run();
              }),
              code(FaultCode::outside_store))
        << "change " << i;
  }
}

TEST(Malformed, KeptSurfacesThatDoNotHoldAreRefused) {
  const std::vector<std::function<void(PeStores&)>> changes = {
      [](PeStores& s) { s.polygons[0].surface = protocol::kept_leaf(0, static_cast<std::uint32_t>(s.kept.size())); },
      [](PeStores& s) { s.polygons[0].surface = protocol::kept_leaf(1, 0); },
      [](PeStores& s) { s.kept[0].node = protocol::kLeaf | static_cast<std::uint32_t>(s.irradiance.size()); },
      [](PeStores& s) { s.kept[0].node = protocol::kept_leaf(0, 0); },  // once more the same
      [](PeStores& s) { s.kept[0].node = static_cast<std::uint32_t>(s.nodes.size()); },
      [](PeStores& s) { s.kept[0].polygon = static_cast<std::uint32_t>(s.polygons.size()); },
  };
  TestScene scene = small_scene();
  scene.keep_surfaces = true;
  for (std::size_t i = 0; i <= changes.size(); ++i) {
    FakeMachine machine(1);
    machine.load(
        scene, Stage::ray_tracing, 64, 1, i < changes.size() ? changes[i] : [](PeStores&) {});
    const std::uint32_t fault = fault_of([&] {
      machine.message(0, MessageKind::begin);
      machine.run();
    });
    EXPECT_EQ(fault, i < changes.size() ? code(FaultCode::outside_store) : 0U) << "change " << i;
  }
}

// Of 36 cells, 30 are not empty: two words. What the map promises, the PE has.
TEST(Malformed, MapsOfCellsThatDoNotHoldAreRefused) {
  const auto fault = [](const std::function<void(PeStores&)>& change) {
    TestScene scene = small_scene();
    scene.cells = {3, 3, 4};
    scene.pes = 2;
    FakeMachine machine(2);
    machine.load(scene, Stage::radiosity, 64, 1, change);
    return fault_of([&] {
      for (const std::uint16_t p : {std::uint16_t{0}, std::uint16_t{1}}) machine.message(p, MessageKind::begin);
      machine.run();
    });
  };
  EXPECT_EQ(fault([](PeStores&) {}), 0U);
  const std::vector<std::function<void(PeStores&)>> changes = {
      [](PeStores& s) { s.cell_words.pop_back(); },
      [](PeStores& s) {
        s.cell_words.push_back({0, static_cast<std::uint32_t>(s.cell_entries.size())});
      },
      [](PeStores& s) { s.cell_words[0].before = 1; },
      [](PeStores& s) { s.cell_words[1].before -= 1; },
      [](PeStores& s) { s.cell_words[1].before += 1; },
      [](PeStores& s) { s.cell_words[0].stops &= s.cell_words[0].stops - 1U; },  // one less than entries
      [](PeStores& s) {  // of the last word: 4 cells; as many bits as before, one of them beyond the grid
        s.cell_words[1].stops = (s.cell_words[1].stops & (s.cell_words[1].stops - 1U)) | 16U;
      },
      [](PeStores& s) { s.cell_entries.pop_back(); },
      [](PeStores& s) { s.cell_entries.push_back(s.cell_entries.back()); },
      [](PeStores& s) { s.cell_entries[3] = protocol::held_as(static_cast<std::uint32_t>(s.subspaces.size())); },
      [](PeStores& s) { s.cell_entries[3] = 2; },  // of two PEs
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_EQ(fault(changes[i]), code(FaultCode::outside_store)) << "change " << i;
  }
  // What another PE has is no PE's own to name itself for: the record would never leave.
  std::uint16_t pe = 0;
  EXPECT_EQ(fault([&pe](PeStores& s) { s.cell_entries[3] = pe++; }), code(FaultCode::outside_store));
}

TEST(Malformed, EmittersThatDoNotHoldAreRefused) {
  TestScene scene = small_scene();
  aim_at(scene, 0);
  const std::vector<std::function<void(PeStores&)>> changes = {
      [](PeStores&) {},
      [](PeStores& s) { s.emitters[1].corner[2][0] = std::numeric_limits<float>::quiet_NaN(); },
      [](PeStores& s) { s.emitters[1].corner[0][1] = -0.5F; },
      [](PeStores& s) { std::swap(s.emitters[0].chosen_to, s.emitters[1].chosen_to); },
      [](PeStores& s) { s.emitters.back().chosen_to -= 1; },
      [](PeStores& s) { s.emitters.pop_back(); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    FakeMachine machine(1);
    machine.load(scene, Stage::ray_tracing, 64, 1, changes[i]);
    EXPECT_EQ(fault_of([&] {
                machine.message(0, MessageKind::begin);
                machine.run();
              }),
              i == 0 ? 0U : code(FaultCode::outside_store))
        << "change " << i;
  }
}

using Change = std::function<void(PeStores&)>;

/// Stores of the small scene hold once `add` has added to them, and no more once one of the changes was made.
void expect_refused(Stage stage, const Change& add, const std::vector<Change>& changes) {
  const auto fault = [&](const Change& change) {
    FakeMachine machine(1);
    machine.load(small_scene(), stage, 64, 1, [&](PeStores& s) {
      add(s);
      change(s);
    });
    return fault_of([&] {
      machine.message(0, MessageKind::begin);
      machine.run();
    });
  };
  EXPECT_EQ(fault([](PeStores&) {}), 0U);
  for (std::size_t i = 0; i < changes.size(); ++i)
    EXPECT_EQ(fault(changes[i]), code(FaultCode::outside_store)) << "change " << i;
}

TEST(Malformed, SkiesThatDoNotHoldAreRefused) {
  const auto add = [](PeStores& s) {
    for (std::uint32_t i = 1; i <= protocol::kSkyEntries; ++i)
      s.sky.push_back({{1, 1, 1}, i * (0xFFFF'FFFFU / protocol::kSkyEntries)});
    s.sky.back().chosen_to = 0xFFFF'FFFFU;
    s.sky_openings = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  };
  const std::vector<Change> changes = {
      [](PeStores& s) { s.sky.pop_back(); },
      [](PeStores& s) { s.sky.push_back(s.sky.back()); },
      [](PeStores& s) { s.sky.back().chosen_to -= 1; },
      [](PeStores& s) { std::swap(s.sky[3].chosen_to, s.sky[4].chosen_to); },
      [](PeStores& s) { s.sky_openings[0].along[0] = 1.5F; },
      [](PeStores& s) { s.sky_openings[0].corner[2] = -0.5F; },
  };
  expect_refused(Stage::radiosity, add, changes);
}

TEST(Malformed, LampsThatDoNotHoldAreRefused) {
  const auto add = [](PeStores& s) {
    s.lamp_values = {1, 0.5F, 0, 2, 2, 1, 1, 0, 0};
    s.lamp_chances = {0x4000'0000, 0x8000'0000, 0xC000'0000, 0xFFFF'FFFF};
    s.lamps = {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {{{2, 2, 0, 3, 0}, {}}}}};
    s.materials[0].lamp = 0;
  };
  const std::vector<Change> changes = {
      [](PeStores& s) { s.materials[0].lamp = 1; },
      [](PeStores& s) { s.lamps[0].side[0].bands = protocol::kMostLampBands + 1; },
      [](PeStores& s) { s.lamps[0].side[0].sectors = 0; },
      [](PeStores& s) { s.lamps[0].side[0].sectors = 3; },
      [](PeStores& s) { s.lamps[0].side[0].heights = 7; },
      [](PeStores& s) { s.lamps[0].side[0].values = 4; },
      [](PeStores& s) { s.lamps[0].side[0].chances = 0xFFFF'FFFFU; },
      [](PeStores& s) {
        s.lamps[0].side[1] = {1, 1, 0, 9, 0};
      },
      [](PeStores& s) { std::swap(s.lamp_chances[1], s.lamp_chances[2]); },
      [](PeStores& s) { s.lamp_chances[3] -= 1; },
  };
  expect_refused(Stage::radiosity, add, changes);
}

TEST(Malformed, TexturesThatLeaveTheirStoresAreRefused) {
  const auto add = [](PeStores& s) {
    s.textures = {{4, 3, 2}};
    s.texels.assign(14, 0);
    s.texture_points.assign(5, {0.5F, -2});
    s.materials[0].texture = 0;
    for (protocol::Polygon& polygon : s.polygons) polygon.texture_points = 2;
  };
  const std::vector<Change> changes = {
      [](PeStores& s) { s.materials[0].texture = 1; },
      [](PeStores& s) { s.textures[0].first_texel = 3; },
      [](PeStores& s) {
        s.textures[0] = {0, 3, 2};
      },
      [](PeStores& s) {
        s.textures[0] = {0x1'0001, 0x1'0000, 0};
      },
      [](PeStores& s) { s.polygons[0].texture_points = 3; },
      [](PeStores& s) { s.polygons[0].texture_points = 0xFFFF'FFFF; },
      [](PeStores& s) { s.texture_points[1].u = std::numeric_limits<float>::quiet_NaN(); },
      [](PeStores& s) { s.texture_points[1].v = 1e9F; },
  };
  expect_refused(Stage::ray_tracing, add, changes);
}

}  // namespace
}  // namespace torolux::test
