// SPDX-License-Identifier: MIT
// A PE's channel on the rank with the network, where the PE itself is not: a mirror of the one on the PE's rank. News
// from there go into it, words for the PE come out. Takes the place of the processor's side. For the scheduler's
// thread.
#pragma once

#include <cstdint>

#include "emulator/niu/channel.hpp"
#include "emulator/remote/stand_ins.hpp"
#include "emulator/remote/wire.hpp"

namespace torolux::remote {

class NetworkEnd {
 public:
  /// channel: zeroed, or set up. stand_ins: all PEs'; outlives this.
  NetworkEnd(NiuChannel& channel, StandIns& stand_ins);

  /// news: of this PE; rest: what follows them. Throws MachineFailure where they cannot be.
  void take(const News& news, ByteReader& rest);
  /// The network says that the PE is to look again.
  void wake() { wakes_ = true; }
  /// Asks the PE's rank for news, once until there are some. True: it is to be asked.
  bool ask();
  /// The channel is as a saved run has left it, and so will that on the PE's rank be.
  void resume();
  /// What the network has written since the last time; nothing is written where it is nothing. True: something.
  bool collect(unsigned pe, ByteWriter& words);

 private:
  bool has_news() const;
  void take_command(std::uint32_t pe, ByteReader& rest);
  void push(const Command& command, std::span<const std::byte> contents);
  void push_stand_in(const PacketName& name, const Command& command);
  void put_arrival(const Arrival& arrival, ByteWriter& words);

  NiuChannel* channel_;
  StandIns* stand_ins_;
  bool wakes_ = false;
  bool woken_ = false;  // since the last news, and nothing has been new since
  bool asked_ = false;
  std::uint64_t told_torus_ = 0, told_bus_ = 0, told_horizon_ = 0, told_wakes_ = 0, told_consumed_ = 0;
  std::uint64_t received_ = 0;  // bytes of commands
  std::uint64_t kept_ = 0;      // packets whose payloads its rank has sent another way
};

}  // namespace torolux::remote
