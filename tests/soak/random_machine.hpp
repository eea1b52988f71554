// SPDX-License-Identifier: MIT
// A machine by chance: a seed in; size, links, buffers, credits, faults and delays out, all within what is allowed.
#pragma once

#include <random>
#include <sstream>
#include <string>

#include "emulator/machine/machine.hpp"
#include "tests/support/least_queues.hpp"

namespace torolux::test {

class MachineDice {
 public:
  explicit MachineDice(std::uint32_t seed) : random_(seed) {}

  /// low..high, both included.
  std::uint32_t number(std::uint32_t low, std::uint32_t high) {
    return low + static_cast<std::uint32_t>(random_() % (high - low + 1));
  }
  bool chance(std::uint32_t of) { return number(1, of) == 1; }

  /// Half of the machines are ideal, the others have faults and delays. Few slots force diversion, few credits starve.
  MachineDescription description() {
    MachineDescription machine;
    machine.torus.flit_bytes = 4U << number(0, 3);
    machine.torus.router_cycles = number(1, 9);
    machine.torus.link_cycles = number(1, 40);
    machine.torus.buffer_packets = number(2, 5);
    machine.torus.slot_return_cycles = number(1, 20);
    machine.torus.patience_cycles = chance(2) ? number(1, 50) : 1024;
    machine.torus.send_queue_packets = number(1, 5);
    machine.torus.retry_cycles = number(1, 30);
    machine.bus.bytes_per_cycle = 1U << number(0, 5);
    machine.bus.arbitration_cycles = number(1, 9);
    machine.bus.send_queue_messages = number(1, 5);
    machine.bus.control_buffers = number(1, 4);
    machine.bus.signal_cycles = number(1, 40);
    machine.niu.bytes_per_cycle = 1U << number(0, 5);
    machine.niu.receive_packets = number(1, 3);
    machine.ideal = {chance(4), chance(4), chance(4)};
    machine.frame_buffer.cycles_per_pixel = number(1, 30);
    machine.frame_buffer.queue_messages = number(1, 16);
    machine.host.cost_factor = chance(3) ? 0 : number(1, 20);
    machine.records.credits_per_pe = chance(3) ? number(1, 8) : number(9, 600);
    machine.records.niu_slots = chance(3) ? number(16, 24) : number(25, 600);
    machine.records.gather_cycles = chance(3) ? 0 : 1U << number(4, 20);
    machine.records.gather_records = chance(3) ? number(1, 40) : 4096;
    if (chance(4)) take_least_of_all(machine);
    if (chance(2)) machine.torus.link_error_rate = number(1, chance(2) ? 200 : 500) * 1e-3;
    if (chance(2)) machine.jitter = {.seed = number(1, 1'000'000), .cycles = number(1, 3000)};
    return machine;
  }

 private:
  static void take_least_of_all(MachineDescription& machine) {
    take_least_queues(machine);
    machine.records.niu_slots = 16;
  }

  std::mt19937 random_;
};

/// For the message of a test that fails.
inline std::string to_text(const MachineDescription& machine, unsigned columns, unsigned rows) {
  std::ostringstream text;
  text << columns << "x" << rows << " PEs, flit " << machine.torus.flit_bytes << ", router "
       << machine.torus.router_cycles << ", link " << machine.torus.link_cycles << ", buffers "
       << machine.torus.buffer_packets << ", slot return " << machine.torus.slot_return_cycles << ", queues "
       << machine.torus.send_queue_packets << "/" << machine.bus.send_queue_messages << ", bus "
       << machine.bus.bytes_per_cycle << ", control buffers " << machine.bus.control_buffers << ", FBC "
       << machine.frame_buffer.cycles_per_pixel << "/" << machine.frame_buffer.queue_messages << ", signals "
       << machine.bus.signal_cycles << ", NIU " << machine.niu.bytes_per_cycle << "/" << machine.niu.receive_packets
       << ", ideal " << machine.ideal.host << machine.ideal.niu << machine.ideal.signals << ", host "
       << machine.host.cost_factor << ", credits " << machine.records.credits_per_pe << ", slots "
       << machine.records.niu_slots << ", gathering " << machine.records.gather_cycles << "/"
       << machine.records.gather_records << ", errors " << machine.torus.link_error_rate << ", delays "
       << machine.jitter.seed << "/" << machine.jitter.cycles;
  return text.str();
}

}  // namespace torolux::test
