// SPDX-License-Identifier: MIT
// Small machines for tests: a native PE program and a host program in, what the host saw and the figures out.
#pragma once

#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "emulator/machine/machine.hpp"
#include "tests/native_engine/native_engine.hpp"

namespace torolux::test {

using pe::Niu;
using protocol::ArrivalKind;
using protocol::kFirstProgramMessage;

struct Heard {
  Cycles time;
  PeNumber source;
  std::uint16_t kind;
  std::vector<std::byte> bytes;

  template <class T>
  T as() const {
    T value{};
    std::memcpy(&value, bytes.data(), std::min(bytes.size(), sizeof value));
    return value;
  }
};

/// A host program that keeps what it hears, and has finished after a number of messages.
class ListeningHost : public HostProgram {
 public:
  explicit ListeningHost(std::size_t expected) : expected_(expected) {}
  std::function<void(HostPort&)> at_start;
  std::function<void(HostPort&, const Heard&)> at_message;
  std::vector<Heard> heard;
  /// What was read of the frame buffer.
  struct Pixels {
    Cycles time;
    FrameRead read;
    std::vector<PixelSums> sums;
  };
  std::vector<Pixels> pixels;

  void start(HostPort& port) override {
    if (at_start) at_start(port);
  }
  void on_message(HostPort& port, PeNumber source, std::uint16_t kind, std::span<const std::byte> contents) override {
    heard.push_back({port.now(), source, kind, {contents.begin(), contents.end()}});
    const Heard last = heard.back();
    if (at_message) at_message(port, last);
  }
  void on_pixels(HostPort& port, const FrameRead& read, std::span<const PixelSums> sums) override {
    pixels.push_back({port.now(), read, {sums.begin(), sums.end()}});
  }
  bool finished() const override { return heard.size() >= expected_; }
  const char* waiting_for() const override { return "more messages"; }

 private:
  std::size_t expected_;
};

inline MachineSetup small_machine(unsigned columns, unsigned rows) {
  MachineSetup setup;
  setup.columns = columns;
  setup.rows = rows;
  setup.local_memory_bytes = 256U * 1024U;
  setup.engine = "native";
  return setup;
}

/// Everything of the figures that must repeat exactly.
inline std::string exact(const MachineFigures& figures) {
  std::string text = std::to_string(figures.now) + " hops " + std::to_string(figures.packets.hops) + " retries " +
                     std::to_string(figures.link_retries) + " bus " + std::to_string(figures.bus.busy_cycles()) + "/" +
                     std::to_string(figures.bus.transfers) + " pixels " + std::to_string(figures.pixels_added) +
                     " trace " + std::to_string(figures.trace_hash) + "\n";
  for (const PeFigures& pe : figures.pes) {
    for (const std::uint64_t value :
         {pe.busy_cycles, pe.idle_cycles(), pe.instructions, pe.packets_sent, pe.packets_delivered, pe.records_diverted,
          std::uint64_t{pe.record_slots_high_water}}) {
      text += std::to_string(value) + " ";
    }
    text += "\n";
  }
  return text;
}

/// A 64-byte record of a test.
struct TestRecord {
  std::uint32_t source, number, life, unused;
  std::array<std::uint32_t, 12> rest;
};
static_assert(sizeof(TestRecord) == 64);

inline constexpr std::uint32_t kOwnSlots = 32;
inline constexpr std::uint16_t kText = kFirstProgramMessage;
inline constexpr std::uint16_t kGo = kFirstProgramMessage + 1;
inline constexpr std::uint16_t kDone = kFirstProgramMessage + 2;

inline std::uint32_t slots_address(Niu& niu) {
  return niu.memory().stores_begin();
}
inline void set_test_slots(Niu& niu, std::uint32_t niu_slots) {
  niu.set_slots(slots_address(niu), sizeof(TestRecord), kOwnSlots, niu_slots);
}
inline TestRecord& record(Niu& niu, std::uint32_t slot) {
  return niu.memory().at<TestRecord>(slots_address(niu))[slot];
}
inline void send_one(Niu& niu, unsigned to, std::uint16_t slot) {
  const std::array<std::uint16_t, 1> slots = {slot};
  niu.send_records(static_cast<std::uint16_t>(to), slots);
}
/// Never returns: sleeps until the machine stops.
inline void sleep_for_ever(Niu& niu) {
  for (;;) niu.receive();
}

}  // namespace torolux::test
