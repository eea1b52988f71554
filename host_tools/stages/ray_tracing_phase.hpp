// SPDX-License-Identifier: MIT
// The ray tracing stage where the host makes the camera rays: they go out as long as there are credits.
#pragma once

#include <vector>

#include "host_tools/camera/camera_rays.hpp"
#include "host_tools/layout/placement.hpp"
#include "host_tools/stages/credit_pool.hpp"
#include "host_tools/stages/ray_phase.hpp"

namespace torolux {

class RayTracingPhase : public RayPhase {
 public:
  RayTracingPhase(const Placement& placement, CameraRays rays, const RayTracingSettings& settings);

  void start(HostPort& port) override;
  void on_message(HostPort& port, PeNumber source, protocol::MessageKind kind,
                  std::span<const std::byte> contents) override;
  bool done() const override { return next_ == end_ && credits_.all_home(); }
  const char* waiting_for() const override { return "credits of camera rays"; }
  void save(SnapshotWriter& archive) override { this->archive(archive); }
  void restore(SnapshotReader& archive) override { this->archive(archive); }

  std::uint64_t made() const override { return next_; }
  std::uint64_t count() const override { return count_; }
  std::uint64_t sent() const override { return sent_; }
  std::uint64_t credits_home() const override { return credits_.home(); }
  void give_up() override { end_ = next_; }

 private:
  template <class Archive>
  void archive(Archive& archive) {
    archive(next_, sent_, turn_, credits_);
  }

  void make_rays(HostPort& port);
  void make_ray(HostPort& port);
  PeNumber follower_of(CellIndex cell);
  void flush(HostPort& port, PeNumber pe);

  const Placement& placement_;
  CameraRays rays_;
  RayTracingSettings settings_;
  std::vector<bool> filled_;                              ///< by cell
  std::vector<std::vector<protocol::RayRecord>> packet_;  ///< being filled, by PE
  std::vector<PeNumber> open_;                            ///< PEs with a packet being filled
  std::uint64_t stride_;                                  ///< of the order in which pixels are taken
  std::uint64_t count_;
  std::uint64_t end_;  ///< the first that is not made
  std::uint64_t next_ = 0;
  std::uint64_t sent_ = 0;
  std::uint64_t turn_ = 0;
  CreditPool credits_;
};

}  // namespace torolux
