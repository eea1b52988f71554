// SPDX-License-Identifier: MIT
// Tells records apart by their size, and by the fields that say what they are.
#include "host_tools/stages/light_program.hpp"

#include <array>

#include "firmware/protocol/records.hpp"

namespace torolux {
namespace {

using protocol::RadiosityRecord;
using protocol::RayRecord;
using protocol::RecordKind;

constexpr std::array<std::string_view, 6> kNames = {"light", "point", "deposit", "ray", "shadow_ray", "gather"};
/// A bit that the kinds of final gathering have, and no other.
constexpr std::uint8_t kOfGathering = 4;
constexpr bool tells_gathering() {
  for (std::uint8_t kind = 0; kind <= static_cast<std::uint8_t>(RecordKind::answer); ++kind) {
    if (protocol::is_of_gathering(RecordKind{kind}) != ((kind & kOfGathering) != 0)) return false;
  }
  return true;
}
static_assert(tells_gathering());
constexpr std::array<KindRule, 6> kRules = {{
    {sizeof(RadiosityRecord), offsetof(RadiosityRecord, kind), 0xFF, static_cast<std::uint8_t>(RecordKind::deposit), 2},
    {sizeof(RadiosityRecord), offsetof(RadiosityRecord, kind), 0xFF, static_cast<std::uint8_t>(RecordKind::point), 1},
    {sizeof(RadiosityRecord), offsetof(RadiosityRecord, kind), kOfGathering, kOfGathering, 5},
    {sizeof(RadiosityRecord), 0, 0, 0, 0},
    {sizeof(RayRecord), offsetof(RayRecord, flags), protocol::kShadow, protocol::kShadow, 4},
    {sizeof(RayRecord), 0, 0, 0, 3},
}};

}  // namespace

std::span<const std::string_view> LightProgram::record_kinds() const {
  return kNames;
}

std::size_t LightProgram::record_kind(std::span<const std::byte> record) const {
  return kind_by(kRules, record);
}

std::span<const KindRule> LightProgram::kind_rules() const {
  return kRules;
}

}  // namespace torolux
