// SPDX-License-Identifier: MIT
// Synthetic traffic on a torus alone: a pattern and a rate in; throughput, latency, load and fairness out.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "emulator/description/description.hpp"
#include "emulator/time/event_queue.hpp"

namespace torolux {

struct TrafficSetup {
  unsigned columns = 8, rows = 8;
  MachineDescription machine;  ///< its torus and jitter
  std::string pattern = "uniform";
  bool to_itself = false;  ///< whether packets to oneself are made; they use no link
  double rate = 0.1;       ///< offered by each node that sends [flits / cycle], 0 < rate <= 1
  std::uint32_t packet_flits = 4;
  std::uint32_t seed = 1;
  Cycles warm_up = 5000;         ///< before anything is measured
  std::optional<Cycles> cycles;  ///< in which it is; absent: enough for some 100 packets of each node
};
inline constexpr std::uint32_t kMostTrafficFlits = 4096;

/// Latencies are those of packets made while it is measured, from being made to the tail's arrival [cycles], as far as
/// they have arrived when the run ends; the rest is what happened in that time.
struct TrafficFigures {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  double offered = 0;   ///< TrafficSetup::rate
  double accepted = 0;  ///< delivered, per node that sends [flits / cycle]
  /// Not a number where no packet that was made while it is measured has arrived.
  double mean_latency = kNone, p99_latency = kNone, max_latency = kNone, mean_hops = kNone;
  double max_link_load = 0;       ///< of the busiest link [flits / cycle]
  double fairness = 0;            ///< least over mean of what was delivered of each node that sends
  std::uint64_t packets = 0;      ///< that latencies are of
  std::uint64_t packet_hops = 0;  ///< links crossed by whole packets in the whole run
  Cycles end = 0;                 ///< of the run
};

/// Each node makes packets by chance (Bernoulli), whenever its outgoing queue has no place they wait before it. It goes
/// on making them after what is measured, for up to half as long, until all that is measured has arrived; beyond
/// saturation that may be never, so after three times as long the run ends.
/// keep_on: asked now and then; false ends the run with Interrupted. Throws UsageError, InputError (rate, lengths,
/// a pattern that does not fit), MachineFailure for a deadlock: packets are left, and nothing can happen any more.
TrafficFigures run_traffic(const TrafficSetup& setup, const std::function<bool()>& keep_on = {});

}  // namespace torolux
