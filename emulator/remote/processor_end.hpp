// SPDX-License-Identifier: MIT
// A PE's channel on the rank that runs the PE: words from the network go into it, news of the processor come out. Takes
// the place of NiuNetworkSide there. For one thread, beside the engine's.
#pragma once

#include <cstdint>

#include "emulator/niu/channel.hpp"
#include "emulator/niu/waker.hpp"
#include "emulator/remote/arrival_line.hpp"
#include "emulator/remote/payload_lanes.hpp"
#include "emulator/remote/wire.hpp"
#include "emulator/snapshot/archive.hpp"

namespace torolux::remote {

class ProcessorEnd {
 public:
  /// channel: set up. number: of the PE in its machine; index: in the engine. waker: null where the processor sleeps on
  /// its channel.
  ProcessorEnd(NiuChannel& channel, unsigned number, unsigned index, ProcessorWaker* waker)
      : channel_(&channel), waker_(waker), number_(number), index_(index), line_(channel, number) {}

  /// Before the start: payloads of packets to PEs do not go with the news, but into the outbox, where the channel's
  /// RecordKinds knows their records, or nobody asks for kinds.
  void keep_payloads() { keeps_payloads_ = true; }

  /// What is new; nothing is written where nothing is. Gives the processor what had to wait before.
  void collect(ByteWriter& news, PayloadOutbox& payloads);
  /// words: of this PE; rest: what follows them.
  void take(const Words& words, ByteReader& rest);
  void tell_to_stop();
  /// The channel as NiuNetworkSide::save_channel writes it, with all that has come for the PE; while nobody runs it.
  void save(SnapshotWriter& archive);
  /// Before the start: what archive_channel_state of an equal machine has written. Arrivals come in words.
  void restore(SnapshotReader& archive);

  /// Whether nothing comes of it before there are words for it.
  bool rests() const;
  NiuChannel& channel() { return *channel_; }
  ArrivalLine& arrivals() { return line_; }
  const ArrivalLine& arrivals() const { return line_; }

 private:
  struct Drained {
    std::uint32_t commands = 0;
    bool all = true;
  };
  Drained drain(ByteWriter& news, PayloadOutbox& payloads);
  bool keeps_payload_of(const Command& command) const;
  WaitKind says() const { return wait_kind(channel_->wait.load(std::memory_order_seq_cst)); }
  void wake();
  void signal();

  NiuChannel* channel_;
  ProcessorWaker* waker_;
  unsigned number_, index_;
  std::uint64_t told_bound_ = kCommandCycles, told_wait_ = 0;
  std::uint64_t sent_ = 0, consumed_ = 0;  // bytes of commands
  bool blocked_ = false;                   // some have not been sent: the network is to take others in first
  bool keeps_payloads_ = false;
  std::uint64_t kept_ = 0;  // packets whose payloads went into the outbox
  ArrivalLine line_;
};

}  // namespace torolux::remote
