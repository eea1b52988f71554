// SPDX-License-Identifier: MIT
// A PE's channel on the rank with the network, where the PE itself is not: a mirror of the one on the PE's rank. News
// from there go into it, words for the PE come out. Takes the place of the processor's side. For the scheduler's
// thread.
#pragma once

#include <cstdint>

#include "emulator/niu/channel.hpp"
#include "emulator/remote/wire.hpp"

namespace torolux::remote {

class NetworkEnd {
 public:
  /// channel: zeroed, or set up.
  explicit NetworkEnd(NiuChannel& channel);

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
  void push(const Command& command, std::span<const std::byte> contents);

  NiuChannel* channel_;
  bool wakes_ = false;
  bool woken_ = false;  // since the last news, and nothing has been new since
  bool asked_ = false;
  std::uint64_t told_torus_ = 0, told_bus_ = 0, told_horizon_ = 0, told_wakes_ = 0, told_consumed_ = 0;
  std::uint64_t received_ = 0;  // bytes of commands
};

}  // namespace torolux::remote
