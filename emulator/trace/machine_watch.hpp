// SPDX-License-Identifier: MIT
// Between emulation and watcher: what PEs have told enters as it comes, leaves when it is due; samples are taken in
// time.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "emulator/niu/network_side.hpp"
#include "emulator/torus/block.hpp"
#include "emulator/torus/torus.hpp"
#include "emulator/trace/watcher.hpp"

namespace torolux {

/// What is sampled beside NIUs and torus.
struct WatchedActors {
  std::function<std::uint32_t(unsigned)> bus_queue;  ///< of a PE
  std::function<std::uint32_t()> frame_buffer_messages, host_messages;
};

class MachineWatch {
 public:
  /// All references outlive this. The NIUs tell their states from now on.
  MachineWatch(MachineWatcher& watcher, const WatchedMachine& machine, std::vector<NiuNetworkSide>& nius,
               const Torus& torus, WatchedActors actors);

  /// The next event is at `time`; nothing of what it does has been done.
  void before(Cycles time) {
    if (time >= next_sample_) catch_up(time);
  }
  void end(Cycles time);

  void sent(Cycles time, const Block& packet) { watcher_.sent(time, name_of(packet)); }
  void received(Cycles time, const Block& packet);
  void bus_was_busy(Cycles begin, Cycles end, BusKind kind);
  void host_was_busy(Cycles begin, Cycles end);
  void frame_buffer_was_busy(Cycles begin, Cycles end);
  void stage(Cycles begin, std::string_view name) { watcher_.stage(begin, name); }
  void gauge(Cycles begin, HostGauge gauge, double value) { watcher_.gauge(begin, gauge, value); }

 private:
  static constexpr std::size_t kIdle = 0, kBusy = 1;

  static PacketName name_of(const Block& packet) {
    return {packet.number, packet.source, packet.destination, packet.records};
  }
  void catch_up(Cycles time);
  auto to_bus();
  auto to_host();
  auto to_frame_buffer();
  void pass_on(Cycles time);
  void sample(Cycles time);
  static std::uint32_t percent(Cycles busy, Cycles& before, Cycles length);

  MachineWatcher& watcher_;
  std::vector<NiuNetworkSide>& nius_;
  const Torus& torus_;
  WatchedActors actors_;
  std::uint32_t shift_;
  Cycles next_sample_ = 0, last_sample_ = 0;
  std::vector<Fifo<StateChange>> states_;              // of each PE, not yet passed on
  std::vector<std::array<Cycles, kLinks>> link_busy_;  // as of the last sample
  StateTally<kBusStates> bus_{};
  StateTally<2> host_{}, frame_buffer_{};
  // [cycles] busy in all, and as of the last sample.
  Cycles bus_busy_ = 0, host_busy_ = 0, frame_buffer_busy_ = 0;
  Cycles bus_before_ = 0, host_before_ = 0, frame_buffer_before_ = 0;
};

}  // namespace torolux
