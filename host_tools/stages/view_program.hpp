// SPDX-License-Identifier: MIT
// The host's program of one more pass over a picture, on a machine that has ended its ray tracing stage and stays: the
// PEs keep their stores. Enters: camera rays, and which of each pixel's samples; leaves: their sums in the frame
// buffer.
#pragma once

#include <atomic>
#include <memory>

#include "host_tools/camera/camera_rays.hpp"
#include "host_tools/setup/setup.hpp"
#include "host_tools/stages/light_program.hpp"
#include "host_tools/stages/ray_phase.hpp"

namespace torolux {

class ViewProgram : public LightProgram {
 public:
  /// setup: that of the machine's stage, outlives this. rays: with as many samples as that stage had; their picture is
  /// as large as the frame buffer. credits, samples...: as in the stage; pass: inside those samples.
  ViewProgram(const RenderSetup& setup, const CameraRays& rays, const RayTracingSettings& settings);
  ~ViewProgram() override;

  void start(HostPort& port) override;
  void on_message(HostPort& port, PeNumber source, std::uint16_t kind, std::span<const std::byte> contents) override;
  bool finished() const override { return phase_->done(); }
  const char* waiting_for() const override { return phase_->waiting_for(); }

  /// From any thread: no more rays are handed out. Those on their way end, and all credits come home, as always.
  void give_up() { given_up_.store(true, std::memory_order_relaxed); }
  /// The picture lacks rays.
  bool was_given_up() const { return phase_->made() < phase_->count(); }
  double fraction() const { return static_cast<double>(phase_->made()) / static_cast<double>(phase_->count()); }

 private:
  std::unique_ptr<RayPhase> phase_;
  std::atomic<bool> given_up_ = false;
};

}  // namespace torolux
