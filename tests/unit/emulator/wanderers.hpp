// SPDX-License-Identifier: MIT
// A machine under any load: records that wander over the torus and come home. A machine's setup in, its figures out.
#pragma once

#include <string>
#include <vector>

#include "firmware/protocol/random.hpp"
#include "tests/unit/emulator/machine_support.hpp"

namespace torolux::test {

struct Outcome {
  std::vector<Heard> heard;
  std::string figures;
  MachineFigures raw;
};

inline Outcome run(const MachineSetup& setup, ListeningHost& host, const NativeProgram& program,
                   const NativeOptions& options = {}) {
  register_native_engine(program, options);
  const Image image = empty_image();
  Machine machine(setup, image);
  machine.run(host);
  return {host.heard, exact(machine.figures()), machine.figures()};
}

/// Records wander from PE to PE by a hash until their life ends; the last home tells the host. No PE holds state.
inline NativeProgram wanderers(std::uint32_t per_pe, std::uint32_t life, std::uint32_t niu_slots) {
  return [=](Niu& niu, NativeClock& clock) {
    set_test_slots(niu, niu_slots);
    std::uint32_t created = 0;
    std::uint32_t died = 0;
    for (;;) {
      if (created < per_pe) {
        const auto slot = static_cast<std::uint16_t>(created % kOwnSlots);
        record(niu, slot) = {niu.pe(), created, life, 0, {}};
        send_one(niu, protocol::hash_combine(niu.pe(), created) % niu.pes(), slot);
        ++created;
      }
      const auto& arrival = (created < per_pe || died != 0) ? niu.receive_if_any() : niu.receive();
      if (arrival.kind == ArrivalKind::none) {
        if (died != 0) niu.send(static_cast<protocol::MessageKind>(kDone), died);
        died = 0;
        continue;
      }
      const auto slots = arrival.slots;
      const std::uint32_t count = arrival.count;
      for (std::uint32_t i = 0; i < count; ++i) {
        TestRecord& got = record(niu, slots[i]);
        clock.spend(protocol::hash_combine(got.number, got.life) % 300);
        if (--got.life == 0) {
          niu.release(slots[i]);
          ++died;
        } else {
          const std::uint32_t key = protocol::hash_combine(got.source * 1000 + got.number, got.life);
          send_one(niu, key % niu.pes(), slots[i]);
        }
      }
    }
  };
}

/// Counts the records that have come home.
class CountingHost final : public ListeningHost {
 public:
  explicit CountingHost(std::uint64_t records) : ListeningHost(0), records_(records) {}
  bool finished() const override { return home() >= records_; }
  std::uint64_t home() const {
    std::uint64_t sum = 0;
    for (const Heard& one : heard) sum += one.as<std::uint32_t>();
    return sum;
  }

 private:
  std::uint64_t records_;
};

}  // namespace torolux::test
