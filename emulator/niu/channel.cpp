// SPDX-License-Identifier: MIT
// The channel as memory: for engines, which only pass it on.
#include "emulator/niu/channel.hpp"

#include <array>
#include <cstddef>

#include "emulator/niu/processor_side.hpp"
#include "emulator/niu/state_log.hpp"

namespace torolux {

std::size_t niu_channel_bytes() {
  return sizeof(NiuChannel);
}
std::size_t small_niu_channel_bytes() {
  return channel_bytes(kLeastRingBytes);
}
std::uint64_t niu_channel_layout() {
  const std::array<std::size_t, 10> facts{sizeof(NiuChannel),
                                          offsetof(NiuChannel, wanted),
                                          offsetof(NiuChannel, asleep),
                                          offsetof(NiuChannel, processor),
                                          sizeof(ProcessorState),
                                          offsetof(ProcessorState, first_free),
                                          sizeof(StateLog),
                                          sizeof(Command),
                                          sizeof(Arrival),
                                          protocol::kProtocolVersion};
  std::uint64_t layout = 0;
  for (const std::size_t fact : facts) layout = layout * 0x1'0000'01B3U + fact;
  return layout;
}
NiuChannel* niu_channel_at(void* memory) {
  return static_cast<NiuChannel*>(memory);
}

}  // namespace torolux
