// SPDX-License-Identifier: MIT
// A packet that the PE sends to itself would be there twice; there is none.
#include "host_tools/inspect/packet_log.hpp"

#include <string>

#include "emulator/errors.hpp"

namespace torolux {

void PacketLog::begin(const Scene& scene, const RenderSetup& setup, const Quality& quality,
                      const MachineChoice& machine) {
  const unsigned pes = machine.columns * machine.rows;
  if (pe_ >= pes)
    throw InputError("there is no PE " + std::to_string(pe_) + "; the machine has 0 to " + std::to_string(pes - 1));
  if (also_ != nullptr) also_->begin(scene, setup, quality, machine);
}

void PacketLog::keep(Cycles time, const RecordPacket& packet, bool sent) {
  if (packets_.size() == kKept) packets_.pop_front();
  packets_.push_back({time, sent, sent ? packet.destination : packet.source,
                      packet.records.size() / packet.record_bytes, packet.records.size()});
}

void PacketLog::sent(Cycles time, const RecordPacket& packet) {
  if (packet.source == pe_) keep(time, packet, true);
  if (also_ != nullptr) also_->sent(time, packet);
}

void PacketLog::received(Cycles time, const RecordPacket& packet) {
  if (packet.destination == pe_) keep(time, packet, false);
  if (also_ != nullptr) also_->received(time, packet);
}

void PacketLog::came(Cycles time, const BusMessage& message) {
  if (also_ != nullptr) also_->came(time, message);
}

void PacketLog::end(Cycles time) {
  if (also_ != nullptr) also_->end(time);
}

}  // namespace torolux
