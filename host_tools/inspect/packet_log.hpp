// SPDX-License-Identifier: MIT
// The packets of a run enter; the last ones of one PE are kept.
#pragma once

#include <deque>
#include <vector>

#include "host_tools/inspect/answers.hpp"

namespace torolux {

class PacketLog final : public RecordFollower {
 public:
  static constexpr std::size_t kKept = 16;

  /// also: told the same (null: nobody); outlives this.
  PacketLog(unsigned pe, RecordFollower* also) : pe_(pe), also_(also) {}

  void begin(const Scene& scene, const RenderSetup& setup, const Quality& quality,
             const MachineChoice& machine) override;
  void sent(Cycles time, const RecordPacket& packet) override;
  void received(Cycles time, const RecordPacket& packet) override;
  void came(Cycles time, const BusMessage& message) override;
  void end(Cycles time) override;

  /// The oldest first.
  std::vector<PassedPacket> packets() const { return {packets_.begin(), packets_.end()}; }

 private:
  void keep(Cycles time, const RecordPacket& packet, bool sent);

  unsigned pe_;
  RecordFollower* also_;
  std::deque<PassedPacket> packets_;
};

}  // namespace torolux
