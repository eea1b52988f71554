// SPDX-License-Identifier: MIT
// The order of reading and writing is that of NiuNetworkSide, for the same reasons.
#include "emulator/remote/processor_end.hpp"

#include <algorithm>
#include <string>

#include "emulator/errors.hpp"
#include "emulator/niu/channel_archive.hpp"
#include "emulator/niu/futex.hpp"

namespace torolux::remote {

void ProcessorEnd::collect(ByteWriter& news, PayloadOutbox& payloads) {
  if (line_.refill()) wake();
  // In this order: a wait that is seen belongs to a bound that is seen, and both to commands that are seen.
  std::uint64_t wait = channel_->wait.load(std::memory_order_seq_cst);
  std::uint64_t bound = channel_->bound.load(std::memory_order_acquire);
  if (bound == told_bound_ && wait == told_wait_ && channel_->commands.empty()) return;
  const std::size_t at = news.size();
  news.put(News{});
  const Drained drained = drain(news, payloads);
  blocked_ = !drained.all;
  // What waits for room here is not over: rank 0 must not believe that the PE waits for something else.
  if (!drained.all && drained.commands == 0 && wait_kind(told_wait_) == WaitKind::running) return news.cut_to(at);
  if (!drained.all) {  // what it says holds for commands, too, that have not been sent
    bound = told_bound_;
    wait = pack_wait(WaitKind::running, 0);
  }
  told_bound_ = bound;
  told_wait_ = wait;
  constexpr auto relaxed = std::memory_order_relaxed;
  News one{number_,
           drained.commands,
           bound,
           wait,
           channel_->clock.load(relaxed),
           channel_->copied.load(relaxed),
           channel_->instructions.load(relaxed),
           channel_->taken.load(relaxed),
           channel_->gather_cycles.load(relaxed),
           channel_->gather_records.load(relaxed),
           {}};
  for (std::size_t i = 0; i < kWaitReasons; ++i) one.waits[i] = channel_->waits[i].load(relaxed);
  news.replace(at, one);
  // One that waits for room in the ring says that it runs.
  if (drained.commands != 0 && says() == WaitKind::running) wake();
}

/// Rank 0 counts kinds, and finds out where a record is of none.
bool ProcessorEnd::keeps_payload_of(const Command& command) const {
  if (!keeps_payloads_ || command.kind != CommandKind::send_records) return false;
  if (channel_->record_kinds == nullptr) return true;
  for (unsigned i = 0; i < command.records; ++i) {
    if ((command.kinds >> (4 * i) & 15U) == 0) return false;
  }
  return true;
}

ProcessorEnd::Drained ProcessorEnd::drain(ByteWriter& news, PayloadOutbox& payloads) {
  auto& ring = channel_->commands;
  Drained drained;
  while (const Command* command = ring.front()) {
    const std::size_t bytes = entry_bytes(*command);
    if (sent_ - consumed_ + bytes > kCommandWindow) {
      drained.all = false;
      break;
    }
    if (keeps_payload_of(*command)) {
      Command header = *command;
      header.lent = static_cast<std::uint16_t>(command->bytes);
      header.bytes = 0;
      news.put(header);
      payloads.put({kept_++, static_cast<std::uint16_t>(number_), command->destination, command->bytes},
                   contents_of(*command));
    } else {
      news.put(*command);
      news.put_bytes(contents_of(*command));
    }
    sent_ += bytes;
    ++drained.commands;
    ring.pop(*command);
  }
  return drained;
}

bool ProcessorEnd::rests() const {
  const std::uint64_t wait = channel_->wait.load(std::memory_order_seq_cst);
  if (wait_kind(wait) != WaitKind::halted && channel_->asleep.load(std::memory_order_seq_cst) == 0) return false;
  return blocked_ || (wait == told_wait_ && channel_->commands.empty());
}

void ProcessorEnd::take(const Words& words, ByteReader& rest) {
  const auto depart = [&rest](Departures& departures, std::uint64_t upto) {
    for (std::uint64_t n = departures.count.load(std::memory_order_relaxed); n < upto; ++n)
      departures.add(n, rest.get<std::uint64_t>());
  };
  depart(channel_->torus_departures, words.torus_departures);
  depart(channel_->bus_departures, words.bus_departures);
  consumed_ = words.consumed;
  line_.take(words, rest);
  const WaitKind says_now = says();
  // It may have begun to wait after the network had told this.
  if (words.wake != 0 || says_now == WaitKind::poll || says_now == WaitKind::torus_place ||
      says_now == WaitKind::bus_place) {
    wake();
  }
}

void ProcessorEnd::save(SnapshotWriter& archive) {
  if (!channel_->commands.empty()) {
    throw MachineFailure("PE " + std::to_string(number_) + " is to be saved with commands that nobody has taken");
  }
  std::atomic<std::uint64_t> horizon = line_.horizon();
  archive_channel_state(archive, *channel_, horizon);
  line_.save(archive);
}

void ProcessorEnd::restore(SnapshotReader& archive) {
  std::atomic<std::uint64_t> of_network = 0;  // told again, behind the arrivals that it speaks of
  archive_channel_state(archive, *channel_, of_network);
  line_.restored();
  told_bound_ = channel_->bound.load(std::memory_order_relaxed);
  told_wait_ = channel_->wait.load(std::memory_order_relaxed);
}

void ProcessorEnd::tell_to_stop() {
  channel_->stopping.store(1, std::memory_order_seq_cst);
  signal();
}

void ProcessorEnd::wake() {
  if (channel_->asleep.load(std::memory_order_seq_cst) == 0) return;
  channel_->asleep.store(0, std::memory_order_relaxed);
  signal();
}

void ProcessorEnd::signal() {
  if (waker_ != nullptr) return waker_->wake(index_);
  channel_->processor_signal.fetch_add(1, std::memory_order_seq_cst);
  futex_wake(channel_->processor_signal);
}

}  // namespace torolux::remote
