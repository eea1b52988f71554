// SPDX-License-Identifier: MIT
// Each number of places in the description, times the largest packet or message that a place may have to hold, with its
// header.
#include "emulator/machine/network_memory.hpp"

#include "emulator/torus/block.hpp"
#include "emulator/torus/shape.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

NetworkMemory network_memory(const MachineDescription& machine) {
  constexpr std::uint64_t kPacket = protocol::kMostPacketBytes + kPacketHeaderBytes;
  constexpr std::uint64_t kMessage = protocol::kMostMessageBytes + sizeof(protocol::MessageHeader);
  return {.send_queue = machine.torus.send_queue_packets * kPacket,
          .receive_buffers = (machine.niu.receive_packets + 1) * kPacket,
          .divert_buffer = kPacket,
          .bus_queue = machine.bus.send_queue_messages * kMessage,
          .control_buffers = machine.bus.control_buffers * kMessage,
          .input_buffers = kLinks * machine.torus.buffer_packets * kPacket,
          .retransmission_buffers = kLinks * kPacket};
}

}  // namespace torolux
