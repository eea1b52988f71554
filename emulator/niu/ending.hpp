// SPDX-License-Identifier: MIT
// The end of a PE that its own HINTs do not tell of. Enters: its channel and what went wrong; leaves: the fault, a
// command like others, so that it comes after all that the PE had done before.
#pragma once

#include <cstdint>

#include "emulator/niu/channel.hpp"

namespace torolux {

/// The PE executes nothing more from `clock` on. To be called by whoever is the processor's side of this channel, or
/// once that is dead. False: there is no room for it yet; try again. Of a PE that has halted, nothing.
bool end_with_fault(NiuChannel& channel, std::uint64_t clock, const NiuFault& fault);
/// Likewise, for one that has run too long without a HINT; in virtual time this ends where the limit is passed,
/// whenever it is noticed. pc: where it is; 0: unknown.
bool end_endless_loop(NiuChannel& channel, std::uint32_t pc);

/// When the limit has been passed [cycles of the PE's clock].
inline std::uint64_t end_of_patience(const NiuChannel& channel) {
  return channel.processor.last_hint + channel.most_cycles_between_hints + 1;
}
NiuFault endless_loop(const NiuChannel& channel, std::uint32_t pc);

}  // namespace torolux
