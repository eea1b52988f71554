// SPDX-License-Identifier: MIT
// Nodes that make packets, the torus that carries them, and the account of what arrives.
#include "emulator/traffic/traffic.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "emulator/errors.hpp"
#include "emulator/torus/torus.hpp"
#include "emulator/traffic/pattern.hpp"
#include "firmware/protocol/random.hpp"

namespace torolux {

namespace {

constexpr Cycles kNever = ~Cycles{0};
constexpr unsigned kMostReported = 16;
constexpr std::uint32_t kAskEvents = 1U << 16U;

void check(const TrafficSetup& setup) {
  if (!(setup.rate > 0 && setup.rate <= 1)) {
    throw InputError("a rate of " + std::to_string(setup.rate) +
                     " flits per node and cycle: a NIU sends one flit a cycle; above 0 and up to 1 are allowed");
  }
  if (setup.packet_flits < 1 || setup.packet_flits > kMostTrafficFlits) {
    throw InputError("packets of " + std::to_string(setup.packet_flits) + " flits: 1 to " +
                     std::to_string(kMostTrafficFlits) + " are allowed");
  }
  if (setup.cycles == Cycles{0}) throw InputError("0 cycles to measure in: at least 1 is needed");
}

/// A node's least share of what the torus delivers is told from chance by so many packets.
constexpr double kPacketsOfANode = 100;
constexpr double kLeastCycles = 20'000, kMostCycles = 1e9;
/// What every pattern gets through a torus of some size, per node [flits / cycle].
constexpr double kServed = 0.25;

Cycles cycles_to_measure(const TrafficSetup& setup, const TrafficPattern& pattern) {
  if (setup.cycles) return *setup.cycles;
  const double served = std::min({setup.rate, kServed, 1.0 / pattern.senders_to_one()});
  return static_cast<Cycles>(std::clamp(kPacketsOfANode * setup.packet_flits / served, kLeastCycles, kMostCycles));
}

class Traffic final : private TorusClient {
 public:
  explicit Traffic(const TrafficSetup& setup)
      : setup_(setup),
        shape_(setup.columns, setup.rows),
        pattern_(make_traffic_pattern(setup.pattern, shape_, setup.to_itself)),
        cycles_(cycles_to_measure(setup, *pattern_)),
        begin_(setup.warm_up),
        end_(begin_ + cycles_),
        last_made_(end_ + cycles_ / 2),
        last_(end_ + 3 * cycles_),
        // Of the chance that a cycle makes no packet.
        log_idle_(std::log1p(-std::min(setup.rate / setup.packet_flits, 1 - 1e-12))),
        events_(3 * std::size_t{shape_.routers()}),
        torus_(shape_, setup.machine.torus, Jitter(setup.machine.jitter.seed, setup.machine.jitter.cycles), events_,
               {.routers = shape_.routers(), .arbiters = 2 * shape_.routers()}, pool_, *this),
        nodes_(shape_.routers()) {}

  TrafficFigures run(const std::function<bool()>& keep_on) {
    for (unsigned node = 0; node < shape_.routers(); ++node) start(node);
    std::uint32_t until_ask = kAskEvents;
    while ((open_ != 0 || waited_for_ != 0) && now_ < last_) {
      if (events_.empty()) {
        throw MachineFailure(
            "deadlock at cycle " + std::to_string(now_) + ": " + std::to_string(torus_.packets_inside()) +
            " packets are in the torus, and nothing can happen any more\n" + torus_.report(kMostReported));
      }
      note_borders(events_.next_time());
      handle(events_.pop());
      if (--until_ask != 0) continue;
      until_ask = kAskEvents;
      if (keep_on && !keep_on()) throw Interrupted("the run was interrupted");
    }
    return figures();
  }

 private:
  struct Node {
    Cycles next = kNever;  // packet to be made
    std::uint32_t destination = 0;
    std::uint32_t made = 0;
    std::uint32_t queued = 0;  // in the outgoing queue
    bool sends = false;
    std::uint64_t flits_delivered = 0;  // of those it sent, while it is measured
  };

  std::uint32_t random(unsigned node, std::uint32_t number, std::uint32_t what) const {
    return protocol::hash_combine(protocol::hash_combine(protocol::hash_combine(setup_.seed, node), number), what);
  }

  void start(unsigned node) {
    Node& one = nodes_[node];
    // A pattern by chance that does not send to itself never names the sender, one without chance always the same.
    one.sends = setup_.to_itself || pattern_->destination(node, 0) != node;
    if (!one.sends) return;
    one.next = 0;
    ++open_;
    make(node, 0);
    wake(node);
  }
  /// The next packet of a node: so many cycles after `from` as a coin with the chance of a packet is thrown.
  void make(unsigned node, Cycles from) {
    Node& one = nodes_[node];
    const double chance = (random(node, one.made, 1) + 0.5) * 0x1p-32;
    const double gap = std::floor(std::log(chance) / log_idle_);
    const Cycles next = from + static_cast<Cycles>(std::min(gap, 1e15));
    const bool was_open = one.next < end_;
    one.next = next < last_made_ ? next : kNever;
    if (was_open && one.next >= end_) --open_;
    one.destination = pattern_->destination(node, random(node, one.made, 2));
  }
  void wake(unsigned node) {
    const Node& one = nodes_[node];
    if (one.next != kNever) events_.push(one.next, node, EventKind::command, static_cast<std::uint16_t>(node), 0, 0);
  }

  /// What links have carried when measuring begins and ends. next: of the next event; there may then be earlier ones.
  void note_borders(Cycles next) {
    if (at_begin_.empty() && next >= begin_) at_begin_ = torus_.router_figures(begin_);
    if (at_end_.empty() && next >= end_) at_end_ = torus_.router_figures(end_);
  }
  void handle(const Event& event) {
    now_ = event.time;
    if (event.kind == EventKind::command) {
      // Port 1: a place in the outgoing queue has come free.
      if (event.port == 1 && nodes_[event.actor].queued-- != setup_.machine.torus.send_queue_packets) return;
      fill_queue(event.actor);
    } else if (event.kind == EventKind::deliver) {
      deliver(event.block);
    } else {
      torus_.handle(event);
    }
  }

  /// Packets that have been made go into the outgoing queue while it has places.
  void fill_queue(unsigned node) {
    Node& one = nodes_[node];
    while (one.next <= now_) {
      if (one.queued == setup_.machine.torus.send_queue_packets) return;
      const BlockIndex index = pool_.take();
      Block& block = pool_[index];
      block.number = (std::uint64_t{node} << 32U) | one.made++;
      block.source = static_cast<std::uint16_t>(node);
      block.destination = static_cast<std::uint16_t>(one.destination);
      block.flits = setup_.packet_flits;
      if (made_at_.size() <= index) made_at_.resize(index + std::size_t{1});
      made_at_[index] = one.next;
      if (one.next >= begin_ && one.next < end_) ++waited_for_;
      ++one.queued;
      torus_.inject(node, index, now_);
      make(node, one.next + 1);
    }
    wake(node);
  }

  void injected(unsigned pe, Cycles tail) override {
    events_.push(tail, pe, EventKind::command, static_cast<std::uint16_t>(pe), 1, 0);
  }
  bool accept(unsigned /*pe*/, BlockIndex /*block*/) override { return true; }

  void deliver(BlockIndex index) {
    const Block& block = pool_[index];
    if (block.copy == Copy::good) {
      const Cycles made = made_at_[index];
      if (made >= begin_ && made < end_) {
        latencies_.push_back(now_ - made);
        hops_ += block.hops;
        --waited_for_;
      }
      if (now_ >= begin_ && now_ < end_) nodes_[block.source].flits_delivered += block.flits;
    }
    pool_.give_back(index);
  }

  TrafficFigures figures() {
    TrafficFigures result;
    result.offered = setup_.rate;
    result.end = now_;
    result.packets = latencies_.size();
    result.packet_hops = torus_.packet_figures().hops;
    std::uint64_t senders = 0;
    std::uint64_t flits = 0;
    std::uint64_t least = ~std::uint64_t{0};
    for (const Node& node : nodes_) {
      if (!node.sends) continue;
      ++senders;
      flits += node.flits_delivered;
      least = std::min(least, node.flits_delivered);
    }
    const auto cycles = static_cast<double>(cycles_);
    const double mean_flits = static_cast<double>(flits) / static_cast<double>(senders);
    result.accepted = mean_flits / cycles;
    result.fairness = mean_flits > 0 ? static_cast<double>(least) / mean_flits : 0;
    if (at_end_.empty()) at_end_ = torus_.router_figures(now_);  // nothing happened after the end
    for (std::size_t router = 0; router < at_end_.size(); ++router) {
      for (std::size_t port = 0; port < kLinks; ++port) {
        const auto sum = [&](const std::vector<RouterFigures>& at) {
          return at.empty() ? 0 : at[router].links[port].flits + at[router].links[port].wasted_flits;
        };
        result.max_link_load =
            std::max(result.max_link_load, static_cast<double>(sum(at_end_) - sum(at_begin_)) / cycles);
      }
    }
    if (latencies_.empty()) return result;
    const auto count = static_cast<double>(latencies_.size());
    std::ranges::sort(latencies_);
    result.mean_latency = static_cast<double>(std::accumulate(latencies_.begin(), latencies_.end(), Cycles{0})) / count;
    // The least latency that at least 99 of 100 packets do not exceed.
    result.p99_latency = static_cast<double>(latencies_[(latencies_.size() * 99 + 99) / 100 - 1]);
    result.max_latency = static_cast<double>(latencies_.back());
    result.mean_hops = static_cast<double>(hops_) / count;
    return result;
  }

  const TrafficSetup& setup_;
  TorusShape shape_;
  std::unique_ptr<TrafficPattern> pattern_;
  Cycles cycles_, begin_, end_, last_made_, last_;
  double log_idle_;
  EventQueue events_;
  BlockPool pool_;
  Torus torus_;
  std::vector<Node> nodes_;
  std::vector<Cycles> made_at_;  // by block
  Cycles now_ = 0;
  std::uint64_t open_ = 0;        // nodes that will make packets that are measured
  std::uint64_t waited_for_ = 0;  // packets in the torus that are measured
  std::vector<Cycles> latencies_;
  std::uint64_t hops_ = 0;
  std::vector<RouterFigures> at_begin_, at_end_;
};

}  // namespace

TrafficFigures run_traffic(const TrafficSetup& setup, const std::function<bool()>& keep_on) {
  check(setup);
  return Traffic(setup).run(keep_on);
}

}  // namespace torolux
