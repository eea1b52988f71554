// SPDX-License-Identifier: MIT
// What tests of malformed input share: a small scene, and the code with which the PE program ends a run.
#pragma once

#include <gtest/gtest.h>

#include <functional>

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

/// The code with which `act` ends the run; 0 if it does not.
inline std::uint32_t fault_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const PeFailed& failed) {
    return failed.fault.code;
  }
  return 0;
}

inline std::uint32_t code(FaultCode c) {
  return static_cast<std::uint32_t>(c);
}

}  // namespace torolux::test
