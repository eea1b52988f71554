// SPDX-License-Identifier: MIT
// Proves: messages and records that do not hold end the run with the right code, and whatever their bytes are, nothing
// outside local memory is touched (run in the sanitizer build: local memory is one heap block).
#include <random>

#include "tests/unit/firmware/pe/malformed.hpp"

namespace torolux::test {
namespace {

TEST(Malformed, MessagesOutOfTurnOrShapeAreRefused) {
  FakeMachine machine(1);
  const auto fault = [&](MessageKind kind, std::size_t bytes) {
    return fault_of([&] {
      const std::vector<std::byte> zeros(bytes);
      machine.message(0, kind, std::span<const std::byte>(zeros));
      machine.run();
    });
  };
  EXPECT_EQ(fault(MessageKind::begin, 0), code(FaultCode::unexpected_message));
  EXPECT_EQ(fault(MessageKind::shoot, sizeof(protocol::Shoot)), code(FaultCode::unexpected_message));
  EXPECT_EQ(fault(MessageKind::deal, sizeof(protocol::Deal)), code(FaultCode::unexpected_message));
  EXPECT_EQ(fault(MessageKind::grant, sizeof(protocol::Grant)), code(FaultCode::unexpected_message));
  EXPECT_EQ(fault(MessageKind{9}, 0), code(FaultCode::unknown_message));
  EXPECT_EQ(fault(MessageKind::ready, 0), code(FaultCode::unknown_message));
  EXPECT_EQ(fault(MessageKind::configure, 20), code(FaultCode::short_message));
  EXPECT_EQ(fault(MessageKind::load, 4), code(FaultCode::short_message));
  EXPECT_EQ(fault(MessageKind::load, 16), code(FaultCode::outside_store));
  machine.begin(small_scene(), Stage::radiosity);
  EXPECT_EQ(fault(MessageKind::begin, 0), code(FaultCode::unexpected_message));
  EXPECT_EQ(fault(MessageKind::load, 16), code(FaultCode::unexpected_message));
  EXPECT_EQ(fault(MessageKind::select, sizeof(protocol::Select)), code(FaultCode::outside_store)) << "of none";
  const auto shot = [&](const protocol::Shoot& s) {
    return fault_of([&] {
      machine.message(0, MessageKind::shoot, s);
      machine.run();
    });
  };
  EXPECT_EQ(shot({{1, 0, 0}, 0, 0, protocol::ShotKind::emitted, 0}), code(FaultCode::outside_store))
      << "more than is there";
  EXPECT_EQ(shot({{-1, 0, 0}, 0, 0, protocol::ShotKind::emitted, 0}), code(FaultCode::outside_store));
  EXPECT_EQ(shot({{0, 0, 0}, 9999, 0, protocol::ShotKind::emitted, 0}), code(FaultCode::outside_store));
  EXPECT_EQ(shot({{0, 0, 0}, 0, 1, protocol::ShotKind::emitted, 0}), code(FaultCode::outside_store)) << "no such side";
  EXPECT_EQ(shot({{0, 0, 0}, 0, 2, protocol::ShotKind::emitted, 0}), code(FaultCode::outside_store));
}

// A shot has one point here: it can be dealt once, to a PE that there is; another shot must wait for that.
TEST(Malformed, PointsAreDealtAsOftenAsThereAre) {
  constexpr std::uint16_t kPes = 4;
  const protocol::Shoot shoot{{0, 0, 0}, 0, 0, protocol::ShotKind::emitted, 0};
  const auto fault = [&](const std::function<void(FakeMachine&)>& act) {
    FakeMachine machine(kPes);
    TestScene scene = small_scene();
    scene.pes = kPes;
    machine.begin(scene, Stage::radiosity);
    machine.message(0, MessageKind::shoot, shoot);
    machine.run();
    return fault_of([&] {
      act(machine);
      machine.run();
    });
  };
  const auto deal = [](std::vector<std::uint16_t> to, std::uint32_t parts = 1) {
    return [to = std::move(to), parts](FakeMachine& machine) { machine.deal(0, to, parts); };
  };
  EXPECT_EQ(fault(deal({1})), 0U);
  EXPECT_EQ(fault(deal({kPes})), code(FaultCode::outside_store));
  EXPECT_EQ(fault(deal({0, 1})), code(FaultCode::outside_store)) << "of one point";
  std::vector<std::uint16_t> parts;
  for (std::uint16_t i = 0; i < protocol::kPointParts; ++i) parts.push_back(i % kPes);
  EXPECT_EQ(fault(deal(parts, protocol::kPointParts)), 0U);
  std::vector<std::uint16_t> too_many = parts;
  too_many.push_back(0);
  EXPECT_EQ(fault(deal(too_many, protocol::kPointParts)), code(FaultCode::outside_store));
  EXPECT_EQ(fault(deal({1}, 3)), code(FaultCode::outside_store));
  EXPECT_EQ(fault(deal({1}, 0)), code(FaultCode::outside_store));
  EXPECT_EQ(fault([](FakeMachine& machine) {
              machine.deal(0, std::array<std::uint16_t, 2>{1, 1}, protocol::kPointParts);
              machine.deal(0, std::array<std::uint16_t, 1>{1}, 1);
            }),
            code(FaultCode::outside_store))
      << "whole, when two parts of it are dealt";
  EXPECT_EQ(fault(deal({})), code(FaultCode::short_message)) << "nobody";
  EXPECT_EQ(fault([&](FakeMachine& machine) {
              machine.message(0, MessageKind::deal, protocol::Deal{65, 1, {}});
            }),
            code(FaultCode::short_message))
      << "more than a message holds";
  EXPECT_EQ(fault([](FakeMachine& machine) {
              const std::array<std::uint32_t, 3> cut{4, 1, 0};  // of four entries two are there
              machine.message(0, MessageKind::deal, cut);
            }),
            code(FaultCode::short_message));
  EXPECT_EQ(fault([&](FakeMachine& machine) {
              machine.deal(0, std::array<std::uint16_t, 1>{1});
              machine.deal(0, std::array<std::uint16_t, 1>{1});
            }),
            code(FaultCode::unexpected_message))
      << "after the last";
  EXPECT_EQ(fault([&](FakeMachine& machine) { machine.message(0, MessageKind::shoot, shoot); }),
            code(FaultCode::unexpected_message))
      << "a shot in the midst of another";
  EXPECT_EQ(fault([](FakeMachine& machine) {
              machine.message(1, MessageKind::deal, protocol::Deal{1, 1, {}});
            }),
            code(FaultCode::unexpected_message))
      << "of no shot";
}

TEST(Malformed, BlocksStayInsideFreeMemory) {
  FakeMachine machine(1);
  machine.begin(small_scene(), Stage::radiosity);
  const std::uint32_t first = machine.pes[0]->stores_begin();
  const std::uint32_t end = machine.pes[0]->memory_end();
  const auto fault = [&](std::uint32_t address, std::uint32_t bytes) {
    return fault_of([&] {
      machine.message(0, MessageKind::read, protocol::Read{address, bytes});
      machine.run();
    });
  };
  EXPECT_EQ(fault(first, 1016), 0U);
  EXPECT_EQ(fault(end - 4, 4), 0U);
  EXPECT_EQ(machine.take(MessageKind::data).size(), 2U);
  for (const auto& [address, bytes] : {std::pair{first - 4, 4U},
                                       {end - 4, 8U},
                                       {end, 4U},
                                       {first, 1020U},
                                       {first, 0U},
                                       {first, 6U},
                                       {first + 2, 4U},
                                       {0xFFFF'FFFCU, 8U}}) {
    EXPECT_EQ(fault(address, bytes), code(FaultCode::outside_store)) << address << " " << bytes;
  }
}

TEST(Malformed, RecordsThatNameWhatIsNotThereAreRefused) {
  const auto fault = [](const std::function<void(RadiosityRecord&)>& change) {
    FakeMachine machine(1);
    machine.begin(small_scene(), Stage::radiosity);
    RadiosityRecord r{};
    r.direction = {0, 0, 1};
    change(r);
    return fault_of([&] { send(machine, r); });
  };
  EXPECT_EQ(fault([](RadiosityRecord&) {}), 0U);
  const std::uint32_t bad = code(FaultCode::bad_record);
  EXPECT_EQ(fault([](RadiosityRecord& r) { r.place = protocol::cell_code(1, 1, 1); }), 0U);
  for (const protocol::CellCode place :
       {protocol::cell_code(2, 0, 0), protocol::cell_code(0, 2, 0), protocol::cell_code(0, 0, 2)}) {
    EXPECT_EQ(fault([=](RadiosityRecord& r) { r.place = place; }), bad) << place;
  }
  EXPECT_EQ(fault([](RadiosityRecord& r) { r.kind = protocol::RecordKind{77}; }), bad);
  EXPECT_EQ(fault([](RadiosityRecord& r) { r.flags = protocol::kEntryAxisMask; }), bad);
  EXPECT_EQ(fault([](RadiosityRecord& r) { r.flux[1] = -1; }), bad);
  const auto deposit = [&](std::uint32_t part, std::uint32_t way, std::uint8_t flags) {
    return fault([=](RadiosityRecord& r) {
      r.kind = protocol::RecordKind::deposit;
      r.place = part;
      r.polygon = way;
      r.flags = flags;
    });
  };
  EXPECT_EQ(deposit(0, 0xFFFF'FFFF, 0), 0U) << "any way ends at a leaf";
  EXPECT_EQ(deposit(9999, 0, 0), bad);
  EXPECT_EQ(deposit(0, 0, protocol::kBackSide), bad);
}

TEST(Malformed, PointsThatDoNotHoldAreRefused) {
  const auto fault = [](const std::function<void(protocol::PointRecord&)>& change, std::uint32_t times = 1) {
    FakeMachine machine(1);
    machine.begin(small_scene(), Stage::radiosity);
    protocol::PointRecord p{};
    p.kind = protocol::RecordKind::point;
    p.origin = {0.5F, 0.5F, 0.1F};
    p.normal = {0, 0, 1};
    p.flux = {1'000, 1'000, 1'000};
    change(p);
    return fault_of([&] {
      for (std::uint32_t i = 0; i < times; ++i) send(machine, p);
      machine.message(0, MessageKind::grant, protocol::Grant{1'000});
      machine.run();
    });
  };
  const std::uint32_t bad = code(FaultCode::bad_record);
  EXPECT_EQ(fault([](protocol::PointRecord&) {}), 0U);
  EXPECT_EQ(fault([](protocol::PointRecord& p) { p.place = protocol::cell_code(1, 1, 2); }), bad);
  EXPECT_EQ(fault([](protocol::PointRecord& p) { p.flux[2] = -1; }), bad);
  EXPECT_EQ(fault([](protocol::PointRecord& p) { p.flags = protocol::kPointParts << protocol::kPartShift; }), 0U);
  EXPECT_EQ(fault([](protocol::PointRecord& p) { p.flags = (protocol::kPointParts + 1U) << protocol::kPartShift; }),
            bad);
  EXPECT_EQ(fault([](protocol::PointRecord& p) { p.flux[0] = (std::int64_t{1} << 56U) + 1; }), bad);
  EXPECT_EQ(fault([](protocol::PointRecord& p) { p.flags = protocol::kLamp; }), bad) << "the scene has none";
  // As many as there are places, with the one whose records are being made.
  EXPECT_EQ(fault([](protocol::PointRecord&) {}, protocol::kPointPlaces), 0U);
  EXPECT_EQ(fault([](protocol::PointRecord&) {}, protocol::kPointPlaces + 1U), bad);
}

TEST(Malformed, PointsOfLampsThatAreNotThereOrDarkAreRefused) {
  const auto fault = [](float lamp, std::uint8_t flags) {
    FakeMachine machine(1);
    machine.load(small_scene(), Stage::radiosity, 64, 1, [](PeStores& s) {
      s.lamp_values = {1, 0, 1, 1};
      s.lamp_chances = {0xFFFF'FFFF};
      s.lamps = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {{{1, 1, 0, 2, 0}, {}}}}};
    });
    machine.message(0, MessageKind::begin);
    protocol::PointRecord p{};
    p.kind = protocol::RecordKind::point;
    p.origin = {0.5F, 0.5F, 0.1F};
    p.normal = {lamp, 0, 0};
    p.flux = {1'000, 1'000, 1'000};
    p.flags = static_cast<std::uint8_t>(protocol::kLamp | flags);
    return fault_of([&] {
      send(machine, p);
      machine.message(0, MessageKind::grant, protocol::Grant{1'000});
      machine.run();
    });
  };
  const std::uint32_t bad = code(FaultCode::bad_record);
  EXPECT_EQ(fault(0, 0), 0U);
  EXPECT_EQ(fault(0, protocol::kBackSide), bad);
  EXPECT_EQ(fault(1, 0), bad);
  EXPECT_EQ(fault(-1, 0), bad);
  EXPECT_EQ(fault(std::numeric_limits<float>::quiet_NaN(), 0), bad);
}

TEST(Malformed, RaysThatNameWhatIsNotThereAreRefused) {
  const std::uint32_t bad = code(FaultCode::bad_record);
  const auto ray = [](const std::function<void(RayRecord&)>& change) {
    FakeMachine machine(1);
    machine.begin(small_scene(), Stage::ray_tracing);
    RayRecord r{};
    r.direction = {0, 0, 1};
    change(r);
    return fault_of([&] { send(machine, r); });
  };
  EXPECT_EQ(ray([](RayRecord&) {}), 0U);
  EXPECT_EQ(ray([](RayRecord& r) { r.place = protocol::cell_code(0, 2, 0); }), bad);
  EXPECT_EQ(ray([](RayRecord& r) { r.waiting = 3; }), bad);
  EXPECT_EQ(ray([](RayRecord& r) { r.kind = protocol::RecordKind::point; }), bad);
  EXPECT_EQ(ray([](RayRecord& r) { r.kind = protocol::RecordKind::deposit; }), bad);
  EXPECT_EQ(ray([](RayRecord& r) {
              r.waiting = 1;
              r.branches[0].place = protocol::cell_code(0, 0, 2);
            }),
            bad);
}

// Of two PEs each keeps every other polygon's surface.
TEST(Malformed, RaysToBeShadedWhereTheSurfaceIsNotKeptAreRefused) {
  const std::uint32_t bad = code(FaultCode::bad_record);
  TestScene scene = small_scene();
  scene.pes = 2;
  scene.keep_surfaces = true;
  const auto ray = [&scene](const std::function<void(RayRecord&)>& change, std::uint32_t kept = 0) {
    FakeMachine machine(2);
    machine.load(scene, Stage::ray_tracing, 64, 1, [kept](PeStores& s) { s.kept[0].polygon = kept; });
    for (std::uint16_t p = 0; p < 2; ++p) machine.message(p, MessageKind::begin);
    machine.run();
    const auto& corner = machine.stores[0].polygons[kept].corner;
    RayRecord r{};
    r.kind = protocol::RecordKind::shade;
    r.origin = {0.5F, 0.5F, 0.5F};
    const glm::vec3 to = (pe::to_vector(corner[0]) + pe::to_vector(corner[1]) + pe::to_vector(corner[2])) / 3.0F;
    r.direction = pe::to_array(glm::normalize(to - pe::to_vector(r.origin)));
    change(r);
    return fault_of([&] { send(machine, r); });
  };
  EXPECT_EQ(ray([](RayRecord&) {}), 0U);
  EXPECT_EQ(ray([](RayRecord& r) { r.target = 0xFFFF'FFFF; }), bad);
  EXPECT_EQ(ray([](RayRecord& r) { r.origin = {-1, 2, 3}; }), bad) << "it does not meet the polygon";
  EXPECT_EQ(ray([](RayRecord& r) { r.flags = protocol::kShadow; }), bad);
  EXPECT_EQ(ray([](RayRecord&) {}, 1), bad) << "the other one keeps it: the ray would go to and fro";
}

// Random bytes in records that look well-formed, NaN and infinities among them, and in messages.
TEST(Malformed, RandomBytesNeverLeaveMemory) {
  std::mt19937 random(11);
  std::uint32_t survived = 0;
  const auto cell = [](auto& from) { return protocol::cell_code(from() % 2, from() % 2, from() % 2); };
  const auto garble = [&](auto& record, std::uint32_t kinds) {
    auto* words = reinterpret_cast<std::uint32_t*>(&record);
    for (std::size_t w = 0; w < sizeof(record) / 4; ++w) {
      const std::uint32_t kind = static_cast<std::uint32_t>(random() % 8);
      if (kind == 0) words[w] = static_cast<std::uint32_t>(random());
      if (kind == 1) words[w] = 0x7FC0'0000;
      if (kind == 2) words[w] = 0xFF80'0000;
    }
    record.place = static_cast<std::uint32_t>(random() % 16 == 0 ? random() : cell(random));
    record.kind = static_cast<protocol::RecordKind>(random() % 16 == 0 ? random() % 4 : random() % kinds);
    record.flags = static_cast<std::uint8_t>(random() & (random() % 64 == 0 ? 0xFFU : 0xDFU));
  };
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const Stage stage = i % 2 == 0 ? Stage::radiosity : Stage::ray_tracing;
    FakeMachine machine(1, 256U << 10U);
    machine.begin(small_scene(), stage, 16);
    const std::uint32_t fault = fault_of([&] {
      for (std::uint32_t k = 0; k < 8; ++k) {
        if (stage == Stage::radiosity) {
          RadiosityRecord r{{0.4F, 0.5F, 0.6F}, {0, 0.6F, 0.8F}, {1000, 10, 1}, 0, 0, 0, {}, 0, 0, 0};
          garble(r, 3);
          for (auto& f : r.flux) f &= (std::int64_t{1} << 50) - 1;
          send(machine, r);
        } else {
          RayRecord r{};
          r.origin = {0.4F, 0.5F, 0.6F};
          r.direction = {0, 0.6F, 0.8F};
          garble(r, 1);
          r.waiting = static_cast<std::uint8_t>(random() % 3);
          for (auto& b : r.branches) {
            b.place = cell(random);
          }
          send(machine, r);
        }
      }
    });
    EXPECT_TRUE(fault == 0 || fault == code(FaultCode::bad_record)) << fault;
    survived += fault == 0 ? 1 : 0;
    if (fault != 0) continue;
    const auto kind = static_cast<MessageKind>(16 + random() % 16);
    std::vector<std::byte> bytes(random() % 200);
    for (auto& b : bytes) b = static_cast<std::byte>(random());
    fault_of([&] {
      machine.message(0, kind, std::span<const std::byte>(bytes));
      machine.run();
    });
  }
  EXPECT_GT(survived, 100U);
}

}  // namespace
}  // namespace torolux::test
