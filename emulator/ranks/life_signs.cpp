// SPDX-License-Identifier: MIT
// A clock and a transport enter, silence leaves.
#include "emulator/ranks/life_signs.hpp"

#include <algorithm>

namespace torolux::ranks {

LifeSigns::LifeSigns(Transport& transport, const std::vector<unsigned>& peers, LifeTimes times)
    : transport_(transport), times_(times) {
  for (const unsigned peer : peers) silence_[peer] = Clock::duration(0);
  sender_ = std::jthread([this, peers](const std::stop_token& stop) { send_signs(stop, peers); });
}

void LifeSigns::send_signs(const std::stop_token& stop, const std::vector<unsigned>& peers) {
  try {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      for (const unsigned peer : peers) transport_.send(peer, kLifeSign, {});
      ended_.wait_for(lock, stop, times_.between, [] { return false; });
    }
  } catch (const RankFailure&) {
    return;  // poll throws the same, where it can be handled
  }
}

std::optional<Message> LifeSigns::poll() {
  while (std::optional<Message> message = transport_.poll()) {
    if (const auto peer = silence_.find(message->from); peer != silence_.end()) peer->second = Clock::duration(0);
    if (message->kind != kLifeSign) return message;
  }
  const Clock::time_point now = Clock::now();
  const Clock::duration since = std::min<Clock::duration>(now - looked_, times_.silence / 8);
  looked_ = now;
  for (auto& [peer, silence] : silence_) silence += since;
  return std::nullopt;
}

std::vector<unsigned> LifeSigns::silent_ones() const {
  std::vector<unsigned> ones;
  for (const auto& [peer, silence] : silence_) {
    if (silence >= times_.silence) ones.push_back(peer);
  }
  return ones;
}

}  // namespace torolux::ranks
