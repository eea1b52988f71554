// SPDX-License-Identifier: MIT
// One record's story. Enter: the packets and messages of a run, as they are seen on torus and bus; leaves: a line for
// each that has to do with the record: time, PE, where it is and goes, what it has met, what it leaves.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulator/torus/shape.hpp"
#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/records.hpp"
#include "host_tools/setup/record_follower.hpp"
#include "host_tools/trace/follow_target.hpp"

namespace torolux {

struct StoryEvent {
  Cycles time;
  std::string who;  ///< a PE, or nobody
  std::string what;
  std::vector<std::uint16_t> routers = {};  ///< where a packet has been received: those that it went through, in order
};

/// One line: cycle, who, what.
std::string text_of(const StoryEvent& event);

class Story final : public RecordFollower {
 public:
  explicit Story(const FollowTarget& target) : target_(target) {}

  void begin(const Scene& scene, const RenderSetup& setup, const Quality& quality,
             const MachineChoice& machine) override;
  void sent(Cycles time, const RecordPacket& packet) override { look_through(time, packet, false); }
  void received(Cycles time, const RecordPacket& packet) override { look_through(time, packet, true); }
  void came(Cycles time, const BusMessage& message) override;
  void end(Cycles time) override;

  /// So far.
  const std::vector<StoryEvent>& events() const { return events_; }
  /// The same as text.
  std::vector<std::string> lines() const;

 private:
  /// A packet with the record on its way.
  struct Leg {
    std::uint64_t packet;
    Cycles sent;
  };

  void tell(Cycles time, const std::string& who, const std::string& what);
  void meets_ray(Cycles time, const RecordPacket& packet, const protocol::RayRecord& ray, bool comes);
  void meets_light(Cycles time, const RecordPacket& packet, const protocol::RadiosityRecord& light, bool comes);
  void meets_point(Cycles time, const RecordPacket& packet, const protocol::PointRecord& point, bool comes);
  void look_through(Cycles time, const RecordPacket& packet, bool comes);
  void leaves(Cycles time, const RecordPacket& packet, const std::string& what);
  void arrives(Cycles time, const RecordPacket& packet);
  void shot(Cycles time, std::uint16_t owner, const protocol::Shoot& shoot);
  std::string what_leaves(const protocol::Shoot& shoot) const;
  void pixels(Cycles time, std::uint16_t source, std::span<const std::byte> contents);

  bool is_followed(const protocol::RayRecord& ray) const;
  std::string watts(const protocol::Flux& flux) const;
  std::string at(const protocol::Vec3f& place) const;
  std::string surface(std::uint32_t polygon) const;
  std::vector<std::uint16_t> route(const RecordPacket& packet) const;
  Cycles unhindered(const RecordPacket& packet) const;

  FollowTarget target_;
  const Scene* scene_ = nullptr;
  const RenderSetup* setup_ = nullptr;
  const Quality* quality_ = nullptr;
  const MachineDescription* machine_ = nullptr;
  std::optional<TorusShape> torus_;
  std::vector<StoryEvent> events_;
  std::vector<Leg> legs_;
  std::optional<std::uint32_t> left_;  ///< polygon that it left when it was last seen
  std::optional<std::uint32_t> shot_key_;
  std::uint32_t key_ = 0;      ///< of the light that is followed
  std::uint32_t bounces_ = 0;  ///< of which its key tells
  std::uint64_t legs_told_ = 0;
  std::array<double, 3> sum_{};  ///< of the pixel [W/(m^2 sr)]
  std::uint64_t adds_ = 0;
};

}  // namespace torolux
