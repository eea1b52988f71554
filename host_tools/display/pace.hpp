// SPDX-License-Identifier: MIT
// How fast a displayed run goes: what pages ask for enters; slow motion and single steps leave, and where each packet
// is meanwhile. All on the run's thread.
#pragma once

#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <unordered_map>

#include "emulator/torus/hop_watcher.hpp"
#include "emulator/trace/pacer.hpp"

namespace torolux {

/// Begins `packets`. Then one PacketPlace for each packet.
struct PacketsHeader {
  std::uint64_t present;     ///< virtual time [cycles]
  double cycles_per_second;  ///< of virtual time in one of the page's; 0: it stands; < 0: as fast as it goes
  std::uint32_t packets;
  std::uint32_t left_out;  ///< packets beyond Pace::kMostPackets
};
static_assert(sizeof(PacketsHeader) == 24);

struct PacketPlace {
  static constexpr std::uint8_t kWaits = 4, kLeaves = 5;

  std::uint32_t number;  ///< differs from those of other packets on the way
  std::uint16_t source, destination;
  std::uint16_t router;  ///< that it is at, or has left last
  std::uint16_t records;
  std::uint8_t way;  ///< Port of the link that it is on; kWaits: it stands at the router; kLeaves: on the way to its PE
  std::uint8_t part;  ///< of that way; 255: all of it
  std::uint16_t unused;
};
static_assert(sizeof(PacketPlace) == 16);

class Pace final : public Pacer, public HopWatcher {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMostPackets = 4096;

  /// {"speed": cycles in a second, 0 stands} or {"speed": "free"} or {"step": "event", "packet" or "round"}. Throws
  /// InputError.
  void obey(const nlohmann::json& values, Clock::time_point now = Clock::now());
  void stand() { free_ = false; }  ///< before the run's first event
  void go_free();
  bool is_free() const { return free_; }

  bool lets(Cycles next) override {
    if (!free_) return lets(next, Clock::now());
    happened_ = next;
    return true;
  }
  bool lets(Cycles next, Clock::time_point now);
  void passed(Step what) override;
  void entered(unsigned pe, const Block& packet) override;
  void leaves(unsigned router, std::size_t output, const Block& packet, Cycles start, Cycles arrives) override;

  /// The contents of a `packets` message. Packets that were on their way before the run was slowed down are there from
  /// their next hop on.
  std::string packets();

 private:
  struct Hop {
    std::uint16_t source, destination, records, router;
    std::uint8_t way;
    Cycles start, arrives;
  };
  Cycles present(Clock::time_point now) const;
  void note(const Block& packet, const Hop& hop);

  bool free_ = true;
  bool steps_ = false;  // goes on until one more `step_` has passed
  Step step_ = Step::event;
  double speed_ = 0;           // [cycles/s]
  Clock::time_point since_{};  // when the speed was set,
  Cycles from_ = 0;            // and the virtual time then
  Cycles happened_ = 0;        // the last event
  Cycles next_ = 0;            // the one that waits
  std::unordered_map<std::uint64_t, Hop> hops_;
};

}  // namespace torolux
