// SPDX-License-Identifier: MIT
// A last command, and no more.
#include "emulator/niu/ending.hpp"

#include <algorithm>
#include <span>

#include "emulator/niu/hint_run.hpp"

namespace torolux {

bool end_with_fault(NiuChannel& channel, std::uint64_t clock, const NiuFault& fault) {
  if (wait_kind(channel.wait.load(std::memory_order_relaxed)) == WaitKind::halted) return true;
  if (!channel.commands.has_room(sizeof fault)) return false;
  // A phase marker in the loop may have promised a later time.
  const std::uint64_t time =
      std::max(command_time(channel.processor, clock), channel.bound.load(std::memory_order_relaxed));
  channel.commands.push({time, CommandKind::fault, 0, 0, 0, 0, 0, 0}, std::as_bytes(std::span(&fault, 1)));
  channel.clock.store(time - kCommandCycles, std::memory_order_relaxed);
  publish_bound(channel, time, pack_wait(WaitKind::halted, 0));
  return true;
}

NiuFault endless_loop(const NiuChannel& channel, std::uint32_t pc) {
  const std::uint64_t most = channel.most_cycles_between_hints;
  return {NiuFaultCode::too_long_without_hint,
          {static_cast<std::uint32_t>(most), static_cast<std::uint32_t>(most >> 32U), pc}};
}

bool end_endless_loop(NiuChannel& channel, std::uint32_t pc) {
  return end_with_fault(channel, end_of_patience(channel), endless_loop(channel, pc));
}

}  // namespace torolux
