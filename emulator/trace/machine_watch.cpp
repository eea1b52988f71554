// SPDX-License-Identifier: MIT
// When what is told is due, and how full everything is at the ends of grains.
#include "emulator/trace/machine_watch.hpp"

#include <algorithm>
#include <utility>

namespace torolux {

MachineWatch::MachineWatch(MachineWatcher& watcher, const WatchedMachine& machine, std::vector<NiuNetworkSide>& nius,
                           const Torus& torus, WatchedActors actors)
    : watcher_(watcher),
      nius_(nius),
      torus_(torus),
      actors_(std::move(actors)),
      shift_(watcher.grain_shift()),
      states_(nius.size()),
      link_busy_(nius.size()) {
  bus_.set_shift(shift_);
  host_.set_shift(shift_);
  frame_buffer_.set_shift(shift_);
  for (std::size_t pe = 0; pe < nius_.size(); ++pe) nius_[pe].watch(&states_[pe]);
  watcher_.begin(machine);
}

/// Where nothing has happened for several grains, the first and the last of them tell all.
void MachineWatch::catch_up(Cycles time) {
  pass_on(time);
  const Cycles last = time >> shift_ << shift_;
  if (next_sample_ < last) sample(next_sample_);
  sample(last);
  next_sample_ = last + (Cycles{1} << shift_);
}

/// What was known before `time`: it is there, however far the PEs have come.
void MachineWatch::pass_on(Cycles time) {
  for (unsigned pe = 0; pe < states_.size(); ++pe) {
    Fifo<StateChange>& changes = states_[pe];
    for (; !changes.empty() && changes.front().known < time; changes.pop_front())
      watcher_.pe_state(pe, changes.front().begin, changes.front().state);
  }
}

/// Of the cycles since the last sample. What is counted when it ends may have begun before that.
std::uint32_t MachineWatch::percent(Cycles busy, Cycles& before, Cycles length) {
  const Cycles share = length != 0 ? (busy - before) * 100 / length : 0;
  before = busy;
  return static_cast<std::uint32_t>(std::min<Cycles>(share, 100));
}

void MachineWatch::sample(Cycles time) {
  const Cycles length = time - last_sample_;
  last_sample_ = time;
  for (unsigned pe = 0; pe < nius_.size(); ++pe) {
    const NiuNetworkSide& niu = nius_[pe];
    std::uint32_t link_use = 0;
    for (std::size_t port = 0; port < kLinks; ++port)
      link_use = std::max(link_use, percent(torus_.link_busy(pe, port, time), link_busy_[pe][port], length));
    watcher_.counters(
        time, pe,
        PeCounters{torus_.queued(pe), actors_.bus_queue(pe), niu.slots_used(), niu.receive_buffers_used(), link_use});
  }
  watcher_.counters(
      time, MachineCounters{static_cast<std::uint32_t>(torus_.packets_inside()), actors_.frame_buffer_messages(),
                            actors_.host_messages(), percent(bus_busy_, bus_before_, length),
                            percent(host_busy_, host_before_, length),
                            percent(frame_buffer_busy_, frame_buffer_before_, length)});
}

void MachineWatch::received(Cycles time, const Block& packet) {
  if (packet.source < nius_.size()) watcher_.received(time, name_of(packet));
}

/// Takes the states of the bus: it is told each.
auto MachineWatch::to_bus() {
  return [this](Cycles begin, std::size_t state) {
    watcher_.bus_state(begin, state);
    return true;
  };
}

auto MachineWatch::to_host() {
  return [this](Cycles begin, std::size_t state) {
    watcher_.host_state(begin, state == kBusy);
    return true;
  };
}

auto MachineWatch::to_frame_buffer() {
  return [this](Cycles begin, std::size_t state) {
    watcher_.frame_buffer_state(begin, state == kBusy);
    return true;
  };
}

void MachineWatch::bus_was_busy(Cycles begin, Cycles end, BusKind kind) {
  bus_.account(begin, kBusIdle, to_bus());
  bus_.account(end, static_cast<std::size_t>(kind), to_bus());
  bus_busy_ += end - begin;
}

void MachineWatch::host_was_busy(Cycles begin, Cycles end) {
  host_.account(begin, kIdle, to_host());
  host_.account(end, kBusy, to_host());
  host_busy_ += end - begin;
}

void MachineWatch::frame_buffer_was_busy(Cycles begin, Cycles end) {
  frame_buffer_.account(begin, kIdle, to_frame_buffer());
  frame_buffer_.account(end, kBusy, to_frame_buffer());
  frame_buffer_busy_ += end - begin;
}

void MachineWatch::end(Cycles time) {
  before(time);
  for (unsigned pe = 0; pe < states_.size(); ++pe) nius_[pe].finish_states(time);
  pass_on(~Cycles{0});
  const auto finish = [time](auto& tally, std::size_t idle, auto put) {
    tally.account(time, idle, put);
    tally.finish(put);
  };
  finish(bus_, kBusIdle, to_bus());
  finish(host_, kIdle, to_host());
  finish(frame_buffer_, kIdle, to_frame_buffer());
  watcher_.end(time);
}

}  // namespace torolux
