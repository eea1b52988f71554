// SPDX-License-Identifier: MIT
// A machine under any load: records that wander over the torus and come home. A machine's setup in, its figures out.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "emulator/errors.hpp"
#include "firmware/protocol/random.hpp"
#include "tests/unit/emulator/machine/machine_support.hpp"

namespace torolux::test {

struct MachineOutcome {
  std::vector<Heard> heard;
  std::string figures;
  MachineFigures raw;
};

inline MachineOutcome run(const MachineSetup& setup, ListeningHost& host, const NativeProgram& program,
                          const NativeOptions& options = {}) {
  register_native_engine(program, options);
  const Image image = empty_image();
  Machine machine(setup, image);
  machine.run(host);
  return {host.heard, exact(machine.figures()), machine.figures()};
}

/// How a run ends that fails.
inline std::string failure_of(const MachineSetup& setup, ListeningHost& host, const NativeProgram& program) {
  try {
    run(setup, host, program);
  } catch (const MachineFailure& failure) {
    return failure.what();
  }
  return "no failure";
}

/// The way of a record that has come: on by a hash of it, until its life ends. True: it has died here.
inline bool wander_on(Niu& niu, NativeClock& clock, std::uint16_t slot) {
  TestRecord& got = record(niu, slot);
  clock.spend(protocol::hash_combine(got.number, got.life) % 300);
  if (--got.life == 0) {
    niu.release(slot);
    return true;
  }
  const std::uint32_t key = protocol::hash_combine(got.source * 1000 + got.number, got.life);
  send_one(niu, key % niu.pes(), slot);
  return false;
}
/// The first step of record `number` of this PE.
inline void set_out(Niu& niu, std::uint32_t number, std::uint32_t life) {
  const auto slot = static_cast<std::uint16_t>(number % kOwnSlots);
  record(niu, slot) = {niu.pe(), number, life, 0, {}};
  send_one(niu, protocol::hash_combine(niu.pe(), number) % niu.pes(), slot);
}

/// Records wander from PE to PE by a hash until their life ends; the last home tells the host. No PE holds state.
inline NativeProgram wanderers(std::uint32_t per_pe, std::uint32_t life, std::uint32_t niu_slots) {
  return [=](Niu& niu, NativeClock& clock) {
    set_test_slots(niu, niu_slots);
    std::uint32_t created = 0;
    std::uint32_t died = 0;
    for (;;) {
      if (created < per_pe) {
        set_out(niu, created, life);
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
      for (std::uint32_t i = 0; i < count; ++i) died += wander_on(niu, clock, slots[i]) ? 1 : 0;
    }
  };
}

/// As wanderers(), but each PE handles what has gathered, then tells the host how many have died.
inline NativeProgram gatherers(std::uint32_t per_pe, std::uint32_t life, std::uint32_t cycles, std::uint32_t enough) {
  return [=](Niu& niu, NativeClock& clock) {
    set_test_slots(niu, 256);
    niu.gather(cycles, enough);
    for (std::uint32_t i = 0; i < per_pe; ++i) set_out(niu, i, life);
    for (;;) {
      std::uint32_t died = 0;
      for (const auto* arrival = &niu.receive(); arrival->kind != ArrivalKind::none; arrival = &niu.receive_more()) {
        const auto slots = arrival->slots;
        const std::uint32_t count = arrival->count;
        for (std::uint32_t i = 0; i < count; ++i) died += wander_on(niu, clock, slots[i]) ? 1 : 0;
      }
      if (died != 0) niu.send(static_cast<protocol::MessageKind>(kDone), died);
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

/// Runs a program whose records all come home several times, each but the first with its threads held up by chance.
/// prepare: called with each run's host.
inline void expect_same_runs(const MachineSetup& setup, const NativeProgram& program, std::uint64_t records,
                             unsigned attempts, const std::function<void(CountingHost&)>& prepare = {}) {
  std::string first;
  for (unsigned attempt = 0; attempt < attempts; ++attempt) {
    NativeOptions options;
    options.before_hint = [attempt](unsigned pe) {
      if (attempt == 0) return;
      thread_local std::minstd_rand random(attempt * 1000 + pe + 1);
      const auto roll = random() % 64;
      if (roll == 0) std::this_thread::sleep_for(std::chrono::microseconds(random() % 300));
      if (roll < 8) std::this_thread::yield();
    };
    CountingHost host(records);
    if (prepare) prepare(host);
    const MachineOutcome outcome = run(setup, host, program, options);
    std::string all = outcome.figures;
    for (const Heard& heard : outcome.heard) {
      all += std::to_string(heard.time) + ":" + std::to_string(heard.source) + " ";
    }
    if (attempt == 0) first = all;
    ASSERT_EQ(all, first) << "attempt " << attempt;
  }
}

}  // namespace torolux::test
