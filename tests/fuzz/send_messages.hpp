// SPDX-License-Identifier: MIT
// What the fuzzers of messages and records do with their bytes: cut them into messages to the host's phases, or records
// and messages to a PE, and let only the refusals pass that each may make.
#pragma once

#include <span>
#include <string>

#include "emulator/errors.hpp"
#include "host_tools/stages/radiosity_phase.hpp"
#include "host_tools/stages/tile_phase.hpp"
#include "tests/fuzz/fuzzed_bytes.hpp"
#include "tests/unit/firmware/pe/fake_machine.hpp"
#include "tests/unit/host_tools/stages/fake_port.hpp"

namespace torolux {

/// Each message: source, kind, a length of 16 bits, contents. True: the phase took them all; false: it failed the run.
inline bool send_to_host(std::span<const std::byte> bytes) {
  constexpr unsigned kPes = 3;
  FuzzedBytes fuzzed(bytes);
  RadiositySettings radiosity;
  radiosity.pes = kPes;
  radiosity.reflectance.assign(30, {protocol::kOne / 2, protocol::kOne / 4, protocol::kOne});
  radiosity.emitted = 10'000;
  radiosity.max_shots = 40;
  radiosity.shot_points = 16;
  radiosity.emission_points = 64;
  RayTracingSettings rays;
  rays.width = 24;
  rays.height = 16;
  RadiosityPhase first(radiosity);
  TilePhase second(kPes, rays);
  Phase& phase = fuzzed.as<std::uint8_t>() % 2 == 0 ? static_cast<Phase&>(first) : second;
  test::FakePort port(kPes);
  try {
    phase.start(port);
    while (!fuzzed.empty() && !phase.done()) {
      const auto source = static_cast<PeNumber>(fuzzed.as<std::uint8_t>() % kPes);
      const auto kind = static_cast<protocol::MessageKind>(fuzzed.as<std::uint8_t>());
      const std::size_t length = fuzzed.as<std::uint16_t>() % (protocol::kMostMessageBytes + 1);
      phase.on_message(port, source, kind, fuzzed.next(length));
      port.take();
    }
    return true;
  } catch (const MachineFailure&) {
    return false;
  }
}

/// Each: what it is, then a record, or a kind, a length of 8 bits and a message's contents. True: the PE took them all.
inline bool send_to_pe(std::span<const std::byte> bytes) {
  static const test::TestScene scene = [] {
    test::TestScene made;
    made.cells = {2, 2, 2};
    made.materials = {test::diffuse_material(0.5F, 1), test::mirror_material(0.5F), test::glass_material(1.5F)};
    made.apart = std::uint32_t{protocol::kDirect} | protocol::kTurned;  // so records of final gathering are taken
    test::add_room(made, {0, 0, 0}, {1, 1, 1}, 1, 0);
    return made;
  }();
  FuzzedBytes fuzzed(bytes);
  const bool radiosity = fuzzed.as<std::uint8_t>() % 2 == 0;
  const std::size_t record_bytes = radiosity ? sizeof(protocol::RadiosityRecord) : sizeof(protocol::RayRecord);
  test::FakeMachine machine(1, 256U << 10U);
  try {
    machine.begin(scene, radiosity ? protocol::Stage::radiosity : protocol::Stage::ray_tracing, 16);
    while (!fuzzed.empty()) {
      if (fuzzed.as<std::uint8_t>() % 2 == 0) {
        std::vector<std::byte> record(record_bytes);
        std::ranges::copy(fuzzed.next(record_bytes), record.begin());
        machine.send({protocol::kHost, 0, {record}});
      } else {
        const auto kind = static_cast<protocol::MessageKind>(fuzzed.as<std::uint8_t>());
        const std::size_t length = fuzzed.as<std::uint8_t>();
        machine.message(0, kind, fuzzed.next(length));
      }
      machine.run();
    }
    return true;
  } catch (const test::PeFailed&) {
    return false;
  }
}

}  // namespace torolux
