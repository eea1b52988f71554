// SPDX-License-Identifier: MIT
// Tells records apart by their size, and by the fields that say what they are.
#include "host_tools/stages/light_program.hpp"

#include <array>

#include "firmware/protocol/records.hpp"

namespace torolux {

std::span<const std::string_view> LightProgram::record_kinds() const {
  static constexpr std::array<std::string_view, 5> kNames = {"light", "point", "deposit", "ray", "shadow_ray"};
  return kNames;
}

std::size_t LightProgram::record_kind(std::span<const std::byte> record) const {
  using protocol::RecordKind;
  if (record.size() == sizeof(protocol::RadiosityRecord)) {
    const auto kind = static_cast<RecordKind>(record[offsetof(protocol::RadiosityRecord, kind)]);
    return kind == RecordKind::deposit ? 2 : kind == RecordKind::point ? 1 : 0;
  }
  if (record.size() != sizeof(protocol::RayRecord)) return kUnknown;
  const auto flags = std::to_integer<std::uint8_t>(record[offsetof(protocol::RayRecord, flags)]);
  return (flags & protocol::kShadow) != 0 ? 4 : 3;
}

}  // namespace torolux
