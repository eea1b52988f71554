// SPDX-License-Identifier: MIT
// Proves: commands and records of final gathering that do not hold end the run, and name the field that does not;
// whatever their bytes are, nothing outside local memory is touched (run in the sanitizer build).
#include <bit>
#include <limits>
#include <random>

#include "tests/unit/firmware/pe/malformed.hpp"

namespace torolux::test {
namespace {

using protocol::Fault;
using protocol::GatherPointRecord;
using protocol::GatherRecord;
using protocol::RecordField;
using protocol::RecordKind;
using protocol::ShotKind;
using protocol::StoreIndex;

constexpr std::uint32_t kTurned = protocol::kTurned;

TestScene gathering_scene(std::uint32_t apart = kTurned) {
  TestScene scene = small_scene();
  scene.apart = apart;
  return scene;
}

constexpr std::uint32_t kElements = 12 * 4;  // of the small scene: its room's

TEST(MalformedGathering, CommandsThatDoNotHoldAreRefused) {
  const auto fault = [](std::int64_t points, ShotKind kind = ShotKind::gathering, std::uint32_t apart = kTurned,
                        std::uint32_t side = 0) {
    FakeMachine machine(1);
    machine.begin(gathering_scene(apart), Stage::radiosity);
    return whole_fault_of([&] {
      machine.message(0, MessageKind::shoot, protocol::Shoot{{points, 0, 0}, 0, side, kind, 0});
      machine.run();
    });
  };
  expect_none(fault(1));
  expect_none(fault(protocol::kMostGatherPoints));
  expect_none(fault(1, ShotKind::gathering, kTurned | protocol::kDirect));
  for (const std::int64_t points : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{protocol::kMostGatherPoints} + 1,
                                    (std::int64_t{1} << 32U) + 1, std::numeric_limits<std::int64_t>::min()}) {
    expect_fault(fault(points), FaultCode::outside_store, StoreIndex::gather_points, std::to_string(points));
  }
  expect_fault(fault(1, ShotKind::gathering, protocol::kDirect), FaultCode::outside_store, StoreIndex::shoot_kind,
               "the layout does not ask for it");
  expect_fault(fault(1, ShotKind{3}), FaultCode::outside_store, StoreIndex::shoot_kind);
  expect_fault(fault(1, ShotKind::gathering, kTurned, 1), FaultCode::outside_store, StoreIndex::shoot_side,
               "it has no back");
}

// A gathering has as many points as it says: none can be dealt beyond, nor another shot begin before.
TEST(MalformedGathering, PointsAreDealtAsOftenAsThereAre) {
  const auto fault = [](const std::function<void(FakeMachine&)>& act) {
    FakeMachine machine(1);
    machine.begin(gathering_scene(), Stage::radiosity);
    const protocol::Shoot shoot{{3, 0, 0}, 0, 0, ShotKind::gathering, 0};
    machine.message(0, MessageKind::shoot, shoot);
    machine.deal(0, std::array<std::uint16_t, 2>{});
    machine.run();
    return whole_fault_of([&] {
      act(machine);
      machine.run();
    });
  };
  expect_none(fault([](FakeMachine& machine) { machine.deal(0, std::array<std::uint16_t, 1>{}); }));
  expect_fault(fault([](FakeMachine& machine) { machine.deal(0, std::array<std::uint16_t, 2>{}); }),
               FaultCode::outside_store, StoreIndex::deal_point);
  EXPECT_EQ(fault([](FakeMachine& machine) {
              machine.message(0, MessageKind::shoot, protocol::Shoot{{1, 0, 0}, 1, 0, ShotKind::gathering, 0});
            }).code,
            code(FaultCode::unexpected_message));
}

/// A ray from the midst of the room up, for its first element.
GatherRecord ray(RecordKind kind) {
  GatherRecord r{};
  r.origin = {0.2F, 0.2F, 0.2F};
  r.direction = {0, 0, 1};
  r.weight = {0.01F, 0.01F, 0.01F};
  r.polygon = protocol::kNoPolygon;
  r.kind = kind;
  r.flags = protocol::kFirst;
  if (kind == RecordKind::question) r.polygon = r.flags = 0;
  return r;
}

GatherPointRecord point() {
  GatherPointRecord p{};
  p.origin = {0.2F, 0.2F, 0.2F};
  p.normal = {0, 0, 1};
  p.area = 0.01F;
  p.polygon = protocol::kNoPolygon;
  p.kind = RecordKind::gather_point;
  return p;
}

RadiosityRecord answer() {
  RadiosityRecord r{};
  r.flux = {1000, 10, 1};
  r.kind = RecordKind::answer;
  return r;
}

/// The PE gets the credits for all rays of a point.
template <class Record>
void send_with_credits(FakeMachine& machine, const Record& record) {
  send(machine, record);
  machine.message(0, MessageKind::grant, protocol::Grant{protocol::hemicube_pixels(4)});
  machine.run();
}

/// On a machine of two PEs, to the first.
template <class Record>
Fault fault_with(Record record, const std::function<void(Record&)>& change, std::uint32_t apart = kTurned) {
  TestScene scene = gathering_scene(apart);
  scene.pes = 2;
  FakeMachine machine(2);
  machine.begin(scene, Stage::radiosity);
  change(record);
  return whole_fault_of([&] { send_with_credits(machine, record); });
}

std::uint32_t elements_of_first_pe() {
  TestScene scene = gathering_scene();
  scene.pes = 2;
  return static_cast<std::uint32_t>(build_stores(scene, Stage::radiosity)[0].elements.size());
}

TEST(MalformedGathering, RecordsWithoutGatheringAreRefused) {
  const auto as_is = [](auto&) {};
  for (const RecordKind kind : {RecordKind::gather, RecordKind::question}) {
    expect_none(fault_with<GatherRecord>(ray(kind), as_is));
    expect_fault(fault_with<GatherRecord>(ray(kind), as_is, protocol::kDirect), FaultCode::bad_record,
                 RecordField::kind);
  }
  expect_none(fault_with<GatherPointRecord>(point(), as_is));
  expect_fault(fault_with<GatherPointRecord>(point(), as_is, protocol::kDirect), FaultCode::bad_record,
               RecordField::kind);
  expect_none(fault_with<RadiosityRecord>(answer(), as_is));
  expect_fault(fault_with<RadiosityRecord>(answer(), as_is, protocol::kDirect), FaultCode::bad_record,
               RecordField::kind);
  expect_fault(fault_with<RadiosityRecord>(answer(), [](RadiosityRecord& r) { r.kind = RecordKind{8}; }),
               FaultCode::bad_record, RecordField::kind);
}

// Gathering is of the radiosity stage: in the other no record is of its kinds.
TEST(MalformedGathering, RaysOfTheOtherStageAreRefused) {
  for (const RecordKind kind :
       {RecordKind::gather_point, RecordKind::gather, RecordKind::question, RecordKind::answer}) {
    FakeMachine machine(1);
    machine.begin(gathering_scene(), Stage::ray_tracing);
    RayRecord r{};
    r.direction = {0, 0, 1};
    r.kind = kind;
    expect_fault(whole_fault_of([&] { send(machine, r); }), FaultCode::bad_record, RecordField::kind);
  }
}

// Of its own elements a PE knows how many there are; another PE's are checked there, when the answer comes.
TEST(MalformedGathering, RaysThatNameWhatIsNotThereAreRefused) {
  const std::uint32_t own = elements_of_first_pe();
  for (const RecordKind kind : {RecordKind::gather, RecordKind::question}) {
    const auto fault = [kind](const std::function<void(GatherRecord&)>& change) {
      return fault_with<GatherRecord>(ray(kind), change);
    };
    const std::string what = kind == RecordKind::gather ? "gather" : "question";
    expect_fault(fault([](GatherRecord& r) { r.home = 2; }), FaultCode::bad_record, RecordField::home, what);
    expect_fault(fault([](GatherRecord& r) { r.home = 0xFFFF; }), FaultCode::bad_record, RecordField::home, what);
    expect_none(fault([own](GatherRecord& r) { r.element = own - 1; }), what);
    expect_fault(fault([own](GatherRecord& r) { r.element = own; }), FaultCode::bad_record, RecordField::element, what);
    expect_none(fault([](GatherRecord& r) { r.home = 1; }), what);
    expect_fault(fault([](GatherRecord& r) {
                   r.home = 1;
                   r.element = kElements;
                 }),
                 FaultCode::bad_record, RecordField::element, what);
  }
  const auto gather = [](const std::function<void(GatherRecord&)>& change) {
    return fault_with<GatherRecord>(ray(RecordKind::gather), change);
  };
  expect_fault(gather([](GatherRecord& r) { r.place = protocol::cell_code(0, 2, 0); }), FaultCode::bad_record,
               RecordField::place);
  expect_fault(gather([](GatherRecord& r) { r.flags = protocol::kEntryAxisMask; }), FaultCode::bad_record,
               RecordField::entry_axis);
  const auto question = [](const std::function<void(GatherRecord&)>& change) {
    return fault_with<GatherRecord>(ray(RecordKind::question), change);
  };
  expect_none(question([](GatherRecord& r) { r.polygon = 0xFFFF'FFFF; }), "any way ends at a leaf");
  expect_fault(question([](GatherRecord& r) { r.place = 9999; }), FaultCode::bad_record, RecordField::part);
  expect_fault(question([](GatherRecord& r) { r.flags = protocol::kBackSide; }), FaultCode::bad_record,
               RecordField::side);
}

TEST(MalformedGathering, AnswersAndPointsThatDoNotHoldAreRefused) {
  const std::uint32_t own = elements_of_first_pe();
  const auto reply = [](const std::function<void(RadiosityRecord&)>& change) {
    return fault_with<RadiosityRecord>(answer(), change);
  };
  expect_none(reply([own](RadiosityRecord& r) { r.key = own - 1; }));
  expect_fault(reply([own](RadiosityRecord& r) { r.key = own; }), FaultCode::bad_record, RecordField::element);
  expect_fault(reply([](RadiosityRecord& r) { r.flux[2] = -1; }), FaultCode::bad_record, RecordField::flux);
  expect_fault(reply([](RadiosityRecord& r) { r.flux[0] = (std::int64_t{1} << 56U) + 1; }), FaultCode::bad_record,
               RecordField::flux);
  const auto fault = [](const std::function<void(GatherPointRecord&)>& change) {
    return fault_with<GatherPointRecord>(point(), change);
  };
  expect_none(fault([own](GatherPointRecord& p) { p.element = own - 1; }));
  expect_fault(fault([own](GatherPointRecord& p) { p.element = own; }), FaultCode::bad_record, RecordField::element);
  expect_fault(fault([](GatherPointRecord& p) { p.home = 2; }), FaultCode::bad_record, RecordField::home);
  expect_none(fault([](GatherPointRecord& p) { p.home = 1; }));
  expect_fault(fault([](GatherPointRecord& p) { p.place = protocol::cell_code(1, 1, 2); }), FaultCode::bad_record,
               RecordField::place);
  expect_fault(fault([](GatherPointRecord& p) {
                 p.flags = static_cast<std::uint8_t>((protocol::kPointParts + 1U) << protocol::kPartShift);
               }),
               FaultCode::bad_record, RecordField::point_part);
  expect_none(fault([](GatherPointRecord& p) { p.flags = protocol::kSky | protocol::kLamp; }),
              "flags of other points mean nothing");
}

// Weights and areas that are no sizes, many times over, add up to anything, but to no harm.
TEST(MalformedGathering, LightThatIsNotFiniteDoesNoHarm) {
  FakeMachine machine(1);
  machine.load(gathering_scene(), Stage::radiosity, 64, 1, [](PeStores& s) {
    for (protocol::Element& element : s.elements) element.flux = {std::int64_t{1} << 56U, 1000, 0};
  });
  machine.message(0, MessageKind::begin);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  expect_none(whole_fault_of([&] {
    for (const float value : {kInfinity, -kInfinity, kNaN, -kNaN, 3e38F, -1.0F}) {
      GatherRecord r = ray(RecordKind::gather);
      r.weight = {value, value, value};
      for (int i = 0; i < 150; ++i) send(machine, r);
      GatherPointRecord p = point();
      p.area = value;
      for (int i = 0; i < 5; ++i) send_with_credits(machine, p);
    }
  }));
  EXPECT_FALSE(pe::has_work(machine.pes[0]->state())) << "every point has ended";
}

// Random bytes in records that look well-formed, NaN and infinities among them.
TEST(MalformedGathering, RandomBytesNeverLeaveMemory) {
  std::mt19937 random(12);
  std::uint32_t survived = 0;
  const auto seldom = [&random] { return random() % 32 == 0; };
  for (std::uint32_t i = 0; i < 1500; ++i) {
    FakeMachine machine(1, 256U << 10U);
    machine.begin(gathering_scene(i % 2 == 0 ? kTurned : kTurned | protocol::kDirect), Stage::radiosity, 16);
    const std::uint32_t fault = fault_of([&] {
      for (std::uint32_t k = 0; k < 8; ++k) {
        auto words = std::bit_cast<std::array<std::uint32_t, 16>>(ray(RecordKind::gather));
        for (std::uint32_t& word : words) {
          const auto kind = static_cast<std::uint32_t>(random() % 8);
          if (kind == 0) word = static_cast<std::uint32_t>(random());
          if (kind == 1) word = 0x7FC0'0000;
          if (kind == 2) word = 0xFF80'0000;
        }
        auto r = std::bit_cast<GatherRecord>(words);
        r.kind = static_cast<RecordKind>(seldom() ? random() : 4 + random() % 4);
        r.place = protocol::cell_code(random() % 2, random() % 2, random() % 2);
        r.flags = static_cast<std::uint8_t>(random() & (seldom() ? 0xFFU : 0x4BU));
        if (!seldom()) r.element = static_cast<std::uint32_t>(random() % kElements);
        if (!seldom()) r.home = 0;
        if (r.kind == RecordKind::answer && !seldom()) r.key = static_cast<std::uint32_t>(random() % kElements);
        if (r.kind == RecordKind::answer && !seldom()) {  // flux within bounds
          r.weight[1] = 0;
          r.unused[0] = r.unused[1] = r.unused[2] = 0;
        }
        if (r.kind == RecordKind::gather_point && !seldom()) r.weight[0] = r.weight[2] = 0;  // element, home
        send_with_credits(machine, r);
      }
    });
    EXPECT_TRUE(fault == 0 || fault == code(FaultCode::bad_record)) << fault;
    survived += fault == 0 ? 1 : 0;
  }
  EXPECT_GT(survived, 100U);
  EXPECT_LT(survived, 1400U);
}

}  // namespace
}  // namespace torolux::test
