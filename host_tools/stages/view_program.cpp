// SPDX-License-Identifier: MIT
// One phase, that of the ray tracing stage. It is asked to hand out nothing more at the next message.
#include "host_tools/stages/view_program.hpp"

#include "host_tools/stages/ray_tracing_phase.hpp"
#include "host_tools/stages/tile_phase.hpp"

namespace torolux {
namespace {

std::unique_ptr<RayPhase> phase_of(const RenderSetup& setup, const CameraRays& rays,
                                   const RayTracingSettings& settings) {
  if (setup.parameters.pixel_samples == 0) {
    return std::make_unique<RayTracingPhase>(setup.ray_placement, rays, settings);
  }
  const protocol::View view{rays.view(), settings.pass.first, settings.pass.count, settings.pass.step};
  return std::make_unique<TilePhase>(setup.placement.torus.pes(), settings, view);
}

}  // namespace

ViewProgram::ViewProgram(const RenderSetup& setup, const CameraRays& rays, const RayTracingSettings& settings)
    : phase_(phase_of(setup, rays, settings)) {}
ViewProgram::~ViewProgram() = default;

void ViewProgram::start(HostPort& port) {
  phase_->start(port);
}

void ViewProgram::on_message(HostPort& port, PeNumber source, std::uint16_t kind, std::span<const std::byte> contents) {
  if (given_up_.load(std::memory_order_relaxed)) phase_->give_up();
  phase_->on_message(port, source, static_cast<protocol::MessageKind>(kind), contents);
}

}  // namespace torolux
