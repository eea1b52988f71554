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
/// Of the kinds of final gathering, and of no other.
constexpr std::uint8_t kOfGathering = 4;
static_assert((static_cast<std::uint8_t>(RecordKind::shade) & kOfGathering) == 0 &&
              (static_cast<std::uint8_t>(RecordKind::gather_point) & kOfGathering) != 0 &&
              (static_cast<std::uint8_t>(RecordKind::answer) & kOfGathering) != 0);
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
