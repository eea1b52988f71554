// SPDX-License-Identifier: MIT
// What tests of malformed input share: a small scene, and the code with which the PE program ends a run.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "firmware/protocol/fault_fields.hpp"
#include "tests/unit/firmware/pe/fake_machine.hpp"

namespace torolux::test {

using pe::FaultCode;
using protocol::MessageKind;
using protocol::RadiosityRecord;
using protocol::RayRecord;
using protocol::Stage;
using protocol::StageLayout;

inline TestScene small_scene() {
  TestScene s;
  s.cells = {2, 2, 2};
  s.materials = {diffuse_material(0.5F, 1), mirror_material(0.5F), glass_material(1.5F)};
  add_room(s, {0, 0, 0}, {1, 1, 1}, 1, 0);
  add_ball(s, {0.5F, 0.5F, 0.5F}, 0.2F, 3, 2, true);
  for (TestPolygon& p : s.polygons) {
    p.element_level = 1;
    if (p.material != 0) p.sides = 0;
  }
  return s;
}

/// To the first PE, as if it came over the torus.
template <class Record>
void send(FakeMachine& machine, const Record& record) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&record);
  machine.send({protocol::kHost, 0, {{bytes, bytes + sizeof(record)}}});
  machine.run();
}

/// The fault with which `act` ends the run; code 0 if it does not.
inline protocol::Fault whole_fault_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const PeFailed& failed) {
    return failed.fault;
  }
  return {};
}
inline std::uint32_t fault_of(const std::function<void()>& act) {
  return whole_fault_of(act).code;
}

inline std::uint32_t code(FaultCode c) {
  return static_cast<std::uint32_t>(c);
}

/// It ends the run by this code, and names this field (fault_fields.hpp).
template <class Field>
void expect_fault(const protocol::Fault& fault, FaultCode c, Field field, const std::string& what = "") {
  EXPECT_EQ(fault.code, code(c)) << what;
  EXPECT_EQ(fault.detail[0], static_cast<std::uint32_t>(field)) << what;
}
inline void expect_none(const protocol::Fault& fault, const std::string& what = "") {
  EXPECT_EQ(fault.code, 0U) << what << ": " << fault.detail[0];
}

}  // namespace torolux::test
