// SPDX-License-Identifier: MIT
// Where light lands: a hit enters; the owner of the element there leaves, and the checks of a record that asks for one.
#pragma once

#include <cstdint>

#include "firmware/pe/follow.hpp"
#include "firmware/protocol/triangle_grid.hpp"

namespace torolux::pe {

/// The side that was hit has elements.
inline bool is_lit(const Scene& scene, const Hit& hit) {
  return (scene.polygons[hit.polygon].sides & (hit.front ? protocol::kFrontPresent : protocol::kBackPresent)) != 0;
}

/// at: becomes the place within the owner's part.
inline const protocol::PatchReference& owner_of(const Scene& scene, const Hit& hit, protocol::Weights& at) {
  const protocol::Polygon& polygon = scene.polygons[hit.polygon];
  at = {(1.0F - hit.b1) - hit.b2, hit.b1, hit.b2};
  const std::uint32_t path = protocol::enter_level(at, polygon.patch_level);
  return scene.patch_references[polygon.surface + path];
}

/// Of a record that has come to the owner.
inline void check_landing(const Pe& pe, Niu& niu, std::uint32_t part, std::uint32_t side) {
  require(niu, part < pe.scene.patch_parts.size(), RecordField::part, part);
  const protocol::Patch& patch = pe.scene.patches[pe.scene.patch_parts[part].patch];
  require(niu, patch.side[side] != protocol::kNoSide, RecordField::side, side);
}

inline void check_flux(Niu& niu, const protocol::Flux& record_flux) {
  constexpr std::int64_t most_flux = std::int64_t{1} << 56U;  // all of a scene's is 3 * 2^48
  for (const std::int64_t flux : record_flux) {
    require(niu, flux >= 0 && flux <= most_flux, RecordField::flux, static_cast<std::uint32_t>(flux >> 32U));
  }
}

}  // namespace torolux::pe
