// SPDX-License-Identifier: MIT
// One credit for each ray, pixels far apart one after the other. Each ray goes in a packet to the PE that holds its
// first subspace, or, where all can begin it, to each in turn.
#include "host_tools/stages/ray_tracing_phase.hpp"

#include <utility>

namespace torolux {
namespace {

using protocol::MessageKind;
using protocol::RayRecord;

constexpr std::size_t kPacket = protocol::records_per_packet(protocol::Stage::ray_tracing);

}  // namespace

RayTracingPhase::RayTracingPhase(const Placement& placement, CameraRays rays, const RayTracingSettings& settings)
    : placement_(placement),
      rays_(std::move(rays)),
      settings_(settings),
      packet_(placement.torus.pes()),
      // Neighbours in time see different parts of the scene: so the load spreads over the PEs.
      stride_(golden_step(std::uint64_t{settings.width} * settings.height)),
      count_(std::uint64_t{settings.width} * settings.height * settings.pass.count),
      end_(count_),
      credits_(settings.credits, placement.torus.pes()) {
  filled_.reserve(placement.polygons_of_cell.size());
  for (const auto& polygons : placement.polygons_of_cell) filled_.push_back(!polygons.empty());
}

void RayTracingPhase::start(HostPort& port) {
  make_rays(port);
}

void RayTracingPhase::on_message(HostPort& port, PeNumber source, MessageKind kind,
                                 std::span<const std::byte> contents) {
  if (kind != MessageKind::credits) unexpected(source, kind, "tracing rays");
  credits_.take_home(port, source, contents);
  make_rays(port);
}

void RayTracingPhase::make_rays(HostPort& port) {
  while (credits_.home() > 0 && next_ < end_) make_ray(port);
  for (const PeNumber pe : std::exchange(open_, {})) flush(port, pe);
  credits_.note(port);
}

/// Where all PEs can begin a ray, they do so in turn.
PeNumber RayTracingPhase::follower_of(CellIndex cell) {
  if (placement_.stop_cell[cell] && !placement_.common_cell[cell]) return placement_.pe_of_cell[cell];
  return static_cast<PeNumber>(turn_++ % placement_.torus.pes());
}

void RayTracingPhase::make_ray(HostPort& port) {
  const std::uint64_t pixels = std::uint64_t{settings_.width} * settings_.height;
  const SamplePass& pass = settings_.pass;
  const auto sample =
      static_cast<std::uint32_t>((pass.first + next_ / pixels) * pass.step % std::uint64_t{settings_.samples});
  const auto pixel = static_cast<std::uint32_t>(next_ % pixels * stride_ % pixels);
  ++next_;
  const CameraRay ray = rays_.ray(pixel, sample);
  std::uint64_t entered = 0;
  const auto start = first_subspace(placement_.grid, ray.origin, ray.direction,
                                    settings_.skip_empty_subspaces ? &filled_ : nullptr, &entered);
  port.work(HostWork::camera_ray, 1);
  port.work(HostWork::subspace, entered);
  if (!start) return;
  RayRecord record{};
  record.target = protocol::kNoPolygon;
  record.origin = ray.origin;
  record.direction = ray.direction;
  const float weight = 1.0F / static_cast<float>(settings_.samples);
  record.weight = {weight, weight, weight};
  record.place = protocol::cell_code(placement_.grid.cell(start->cell));
  record.polygon = protocol::kNoPolygon;
  record.key = ray.key;
  record.pixel = pixel;
  record.sample = static_cast<std::uint16_t>(sample);
  record.kind = protocol::RecordKind::light;
  record.flags = start->flags;
  const PeNumber pe = follower_of(start->cell);
  if (packet_[pe].empty()) open_.push_back(pe);
  packet_[pe].push_back(record);
  credits_.spend();
  ++sent_;
  if (packet_[pe].size() == kPacket) {
    flush(port, pe);
    std::erase(open_, pe);
  }
}

void RayTracingPhase::flush(HostPort& port, PeNumber pe) {
  port.send_records(pe, std::as_bytes(std::span(packet_[pe])), sizeof(RayRecord));
  packet_[pe].clear();
}

}  // namespace torolux
