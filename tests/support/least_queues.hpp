// SPDX-License-Identifier: MIT
// A machine's description enters; the same with one place in each queue and buffer, or as few as are allowed, leaves:
// where a machine would lock first.
#pragma once

#include "emulator/description/description.hpp"

namespace torolux::test {

inline void take_least_queues(MachineDescription& machine) {
  machine.torus.buffer_packets = 2;
  machine.torus.send_queue_packets = 1;
  machine.bus.send_queue_messages = 1;
  machine.bus.control_buffers = 1;
  machine.niu.receive_packets = 1;
  machine.frame_buffer.queue_messages = 1;
}

}  // namespace torolux::test
