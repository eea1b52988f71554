// SPDX-License-Identifier: MIT
// The memory that each PE has beside its local memory: a machine's description in, bytes of the NIU's and the router's
// queues and buffers out.
#pragma once

#include <cstdint>

#include "emulator/description/description.hpp"

namespace torolux {

/// Of one PE [bytes]. A packet's place holds the largest packet and its header, a message's the longest message.
struct NetworkMemory {
  // NIU
  std::uint64_t send_queue;       ///< to the torus
  std::uint64_t receive_buffers;  ///< from the torus, and one from the bus
  std::uint64_t divert_buffer;
  std::uint64_t bus_queue;
  std::uint64_t control_buffers;
  // router
  std::uint64_t input_buffers;           ///< of the four links
  std::uint64_t retransmission_buffers;  ///< of the four links: the packet that is sent, until it has come whole

  std::uint64_t niu() const { return send_queue + receive_buffers + divert_buffer + bus_queue + control_buffers; }
  std::uint64_t router() const { return input_buffers + retransmission_buffers; }
};

/// With an ideal NIU, as if it were not.
NetworkMemory network_memory(const MachineDescription& machine);

}  // namespace torolux
