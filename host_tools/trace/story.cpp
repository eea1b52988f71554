// SPDX-License-Identifier: MIT
// A ray is known by its pixel and sample; light by the key of its random numbers, which follows from shot, point and
// direction and changes at mirrors and glass as firmware/pe does it.
#include "host_tools/trace/story.hpp"

#include <algorithm>
#include <cstring>

#include "emulator/errors.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/torus/block.hpp"
#include "firmware/protocol/niu_window.hpp"
#include "firmware/protocol/random.hpp"
#include "firmware/protocol/record_key.hpp"
#include "firmware/protocol/shot_grid.hpp"
#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

using protocol::RecordKind;

template <typename T>
T read(std::span<const std::byte> bytes, std::size_t at = 0) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::string pe_text(std::uint16_t pe) {
  return "PE " + std::to_string(pe);
}

std::string triple(const std::array<double, 3>& v, int digits) {
  return "(" + significant(v[0], digits) + ", " + significant(v[1], digits) + ", " + significant(v[2], digits) + ")";
}

std::string triple(const protocol::Vec3f& v, int digits) {
  return triple(std::array<double, 3>{v[0], v[1], v[2]}, digits);
}

std::string subspace(std::uint32_t place) {
  return "subspace (" + std::to_string(protocol::cell_along(place, 0)) + ", " +
         std::to_string(protocol::cell_along(place, 1)) + ", " + std::to_string(protocol::cell_along(place, 2)) + ")";
}

std::string joined(const std::vector<std::uint16_t>& routers) {
  std::string text;
  for (const std::uint16_t router : routers) text += (text.empty() ? "" : "-") + std::to_string(router);
  return text;
}

}  // namespace

std::string text_of(const StoryEvent& event) {
  return right(grouped(event.time), 16) + "  " + left(event.who, 8) + event.what;
}

void Story::begin(const Scene& scene, const RenderSetup& setup, const Quality& quality, const MachineChoice& machine) {
  scene_ = &scene;
  setup_ = &setup;
  quality_ = &quality;
  machine_ = &machine.description;
  torus_.emplace(machine.columns, machine.rows);
  if (const auto* pixel = std::get_if<FollowedPixel>(&target_)) {
    if (pixel->column >= quality.width || pixel->row >= quality.height || pixel->sample >= quality.samples)
      throw InputError("--follow: the picture has " + std::to_string(quality.width) + " x " +
                       std::to_string(quality.height) + " pixels of " + std::to_string(quality.samples) +
                       " samples, all counted from 0");
  } else if (std::get<FollowedShot>(target_).direction >= protocol::hemicube_pixels(setup.parameters.hemicube)) {
    throw InputError("--follow: a hemi-cube has " +
                     std::to_string(protocol::hemicube_pixels(setup.parameters.hemicube)) +
                     " pixels, counted from 0 (--hemicube)");
  }
}

void Story::tell(Cycles time, const std::string& who, const std::string& what) {
  events_.push_back({time, who, what});
}

std::vector<std::string> Story::lines() const {
  std::vector<std::string> lines;
  for (const StoryEvent& event : events_) lines.push_back(text_of(event));
  return lines;
}

std::string Story::at(const protocol::Vec3f& place) const {
  return triple(setup_->mesh.space.to_user(to_double(place)), 4);
}

std::string Story::watts(const protocol::Flux& flux) const {
  std::array<double, 3> watts{};
  for (std::size_t c = 0; c < 3; ++c) watts[c] = static_cast<double>(flux[c]) * setup_->units.watts_per_quantum;
  return triple(watts, 3) + " W";
}

std::string Story::surface(std::uint32_t polygon) const {
  if (polygon == protocol::kNoPolygon || polygon >= setup_->mesh.triangles.size()) return "no surface";
  return "polygon " + std::to_string(polygon) + " of '" +
         scene_->materials[setup_->mesh.triangles[polygon].material].name + "'";
}

/// The routers on the way, first and last included.
std::vector<std::uint16_t> Story::route(const RecordPacket& packet) const {
  std::vector<std::uint16_t> routers{packet.source};
  while (routers.back() != packet.destination && routers.size() <= torus_->diameter() + 1) {
    const unsigned next = torus_->neighbour(routers.back(), torus_->route(routers.back(), packet.destination));
    routers.push_back(static_cast<std::uint16_t>(next));
  }
  return routers;
}

/// From the outgoing queue into the record slots with nothing in the way (docs/machine.md, "The torus").
Cycles Story::unhindered(const RecordPacket& packet) const {
  const auto bytes = static_cast<std::uint32_t>(packet.records.size());
  const auto& torus = machine_->torus;
  return Cycles{torus_->hops(packet.source, packet.destination) + 1} * (torus.router_cycles + torus.link_cycles) +
         flits_of(bytes, torus.flit_bytes) - 1 + copy_cycles(bytes, machine_->copy_bytes());
}

void Story::leaves(Cycles time, const RecordPacket& packet, const std::string& what) {
  tell(time, pe_text(packet.source),
       what + "; sent to " + pe_text(packet.destination) + ", packet " + std::to_string(packet.number & 0xFFFF'FFFFU) +
           " of this PE's");
  legs_.push_back({packet.number, time});
}

void Story::arrives(Cycles time, const RecordPacket& packet) {
  for (auto leg = legs_.begin(); leg != legs_.end(); ++leg) {
    if (leg->packet != packet.number) continue;
    const unsigned links = torus_->hops(packet.source, packet.destination);
    tell(time, pe_text(packet.destination),
         "received after " + grouped(time - leg->sent) + " cycles, of which it waited " +
             grouped(time - leg->sent - std::min(time - leg->sent, unhindered(packet))) + ": " + std::to_string(links) +
             (links == 1 ? " link" : " links") + ", routers " + joined(route(packet)));
    events_.back().routers = route(packet);
    legs_.erase(leg);
    ++legs_told_;
    return;
  }
}

void Story::look_through(Cycles time, const RecordPacket& packet, bool comes) {
  const bool of_pixel = std::holds_alternative<FollowedPixel>(target_);
  for (std::size_t first = 0; first + packet.record_bytes <= packet.records.size(); first += packet.record_bytes) {
    if (packet.record_bytes == sizeof(protocol::RayRecord)) {
      if (of_pixel) meets_ray(time, packet, read<protocol::RayRecord>(packet.records, first), comes);
    } else if (!of_pixel && packet.record_bytes == sizeof(protocol::RadiosityRecord)) {
      const auto light = read<protocol::RadiosityRecord>(packet.records, first);
      if (protocol::is_of_gathering(light.kind)) continue;  // no light, but what looks for it
      if (light.kind == RecordKind::point) {
        meets_point(time, packet, read<protocol::PointRecord>(packet.records, first), comes);
      } else {
        meets_light(time, packet, light, comes);
      }
    }
  }
}

bool Story::is_followed(const protocol::RayRecord& ray) const {
  const auto& wanted = std::get<FollowedPixel>(target_);
  return ray.pixel == wanted.row * quality_->width + wanted.column && ray.sample == wanted.sample;
}

void Story::meets_ray(Cycles time, const RecordPacket& packet, const protocol::RayRecord& ray, bool comes) {
  if (!is_followed(ray)) return;
  if (comes && packet.source != protocol::kHost) return arrives(time, packet);
  std::string text;
  if (ray.polygon == protocol::kNoPolygon) {
    text = left_ ? "" : "a camera ray from " + at(ray.origin);
  } else if (left_ != ray.polygon) {
    text = "it has met " + surface(ray.polygon) + " at " + at(ray.origin);
  }
  left_ = ray.polygon;
  if (!text.empty()) text += "; ";
  if (ray.kind == RecordKind::shade) {
    text += "what it has met next is shaded by its keeper";
  } else if ((ray.flags & protocol::kShadow) != 0) {
    text += "a shadow ray to emitter " + surface(ray.target) + ", worth " + triple(ray.weight, 3) +
            " if nothing is before it, enters " + subspace(ray.place);
  } else {
    text += "segment " + std::to_string(ray.bounce + 1) + " towards " + triple(ray.direction, 3) + ", weight " +
            triple(ray.weight, 3) + ", enters " + subspace(ray.place);
  }
  if (ray.waiting > 0)
    text += ", " + std::to_string(ray.waiting) + (ray.waiting == 1 ? " branch waits" : " branches wait");
  if (comes) return tell(time, pe_text(packet.destination), "comes from the host: " + text);
  leaves(time, packet, text);
}

void Story::meets_light(Cycles time, const RecordPacket& packet, const protocol::RadiosityRecord& light, bool comes) {
  if (!shot_key_) return;
  // At a mirror or glass the key is made anew; where it happened within a PE, only the packet behind it tells.
  std::uint32_t key = key_;
  for (std::uint32_t bounce = bounces_; bounce < light.bounce; ++bounce) key = protocol::hash_combine(key, bounce);
  if (light.key != key) return;
  if (comes) return arrives(time, packet);
  key_ = key;
  bounces_ = light.bounce;
  std::string text;
  if (light.kind == RecordKind::deposit) {
    text = "it has met its surface: a deposit of " + watts(light.flux) +
           ((light.flags & protocol::kBackSide) != 0 ? " on the back" : "") + " goes to the element's owner";
  } else {
    if (left_ != light.polygon)
      text = (left_ ? "it has met " : "it leaves ") + surface(light.polygon) + " at " + at(light.origin) + "; ";
    text += "towards " + triple(light.direction, 3) + ", " + watts(light.flux) + ", enters " + subspace(light.place);
    left_ = light.polygon;
  }
  leaves(time, packet, text);
}

void Story::meets_point(Cycles time, const RecordPacket& packet, const protocol::PointRecord& point, bool comes) {
  const auto& wanted = std::get<FollowedShot>(target_);
  const std::uint32_t number = protocol::point_number(point);
  if (!shot_key_ || point.key != *shot_key_ || number != wanted.point) return;
  if (comes) return arrives(time, packet);
  const std::uint32_t part = (point.flags & protocol::kPartMask) >> protocol::kPartShift;
  leaves(time, packet,
         "point " + std::to_string(number) + " of the shot" +
             (part == 0 ? std::string()
                        : ", part " + std::to_string(part) + " of " + std::to_string(protocol::kPointParts)) +
             ", at " + at(point.origin));
}

std::string Story::what_leaves(const protocol::Shoot& shoot) const {
  switch (shoot.kind) {
    case protocol::ShotKind::gathering:
      return "gathers what lights it, from " + grouped(static_cast<std::uint64_t>(shoot.amount[0])) + " points";
    case protocol::ShotKind::emitted:
      return "emits " + watts(shoot.amount);
    case protocol::ShotKind::reflected:
      break;
  }
  return "reflects what has come, " + watts(shoot.amount);
}

void Story::shot(Cycles time, std::uint16_t owner, const protocol::Shoot& shoot) {
  const auto& wanted = std::get<FollowedShot>(target_);
  if (shoot.number != wanted.shot) return;
  const std::uint32_t patch = setup_->placement.patches_of_pe[owner][shoot.patch];
  shot_key_ = protocol::shot_key(setup_->parameters.seed, patch, shoot);
  key_ = protocol::record_key(protocol::point_key(*shot_key_, wanted.point),
                              protocol::pixel_key(*shot_key_, wanted.direction));
  tell(time, pe_text(owner),
       "shot " + std::to_string(shoot.number) + ": patch " + std::to_string(patch) + " of '" +
           scene_->materials[setup_->mesh.patches[patch].material].name + "', " + (shoot.side == 0 ? "front" : "back") +
           ", " + what_leaves(shoot));
}

void Story::pixels(Cycles time, std::uint16_t source, std::span<const std::byte> contents) {
  const auto& wanted = std::get<FollowedPixel>(target_);
  const double radiance = setup_->radiance_per_quantum();
  for (std::size_t first = 0; first + sizeof(protocol::PixelAdd) <= contents.size();
       first += sizeof(protocol::PixelAdd)) {
    const auto add = read<protocol::PixelAdd>(contents, first);
    if (add.plane != protocol::Plane::colour || add.pixel != wanted.row * quality_->width + wanted.column) continue;
    std::array<double, 3> value{};
    for (std::size_t c = 0; c < 3; ++c) {
      value[c] = static_cast<double>(add.value[c]) * radiance;
      sum_[c] += value[c];
    }
    ++adds_;
    tell(time, pe_text(source),
         "adds " + triple(value, 4) + " to the pixel" + (quality_->samples > 1 ? ", of any of its samples" : ""));
  }
}

void Story::came(Cycles time, const BusMessage& message) {
  const auto& [source, destination, kind, contents] = message;
  if (const auto* wanted = std::get_if<FollowedPixel>(&target_)) {
    if (destination == protocol::kFrameBuffer) return pixels(time, source, contents);
    if (source != protocol::kHost || kind != static_cast<std::uint16_t>(protocol::MessageKind::tile)) return;
    const auto tile = read<protocol::Tile>(contents);
    if (wanted->column - tile.column < tile.columns && wanted->row - tile.row < tile.rows)
      tell(time, pe_text(destination),
           "gets the tile of " + std::to_string(tile.columns) + " x " + std::to_string(tile.rows) + " pixels from (" +
               std::to_string(tile.column) + ", " + std::to_string(tile.row) + ") on");
  } else if (source == protocol::kHost && kind == static_cast<std::uint16_t>(protocol::MessageKind::shoot)) {
    shot(time, destination, read<protocol::Shoot>(contents));
  }
}

void Story::end(Cycles time) {
  if (std::holds_alternative<FollowedPixel>(target_)) {
    tell(time, "",
         "the pixel has got " + triple(sum_, 5) + " [W/(m^2 sr)] in " + std::to_string(adds_) +
             (adds_ == 1 ? " addition" : " additions"));
  } else if (!shot_key_) {
    tell(time, "", "there was no such shot");
  }
  if (legs_told_ == 0)
    tell(time, "",
         "it was in no packet: what a PE does within itself is not seen. More PEs, or --scheme paper, show more");
}

}  // namespace torolux
