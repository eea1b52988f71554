// SPDX-License-Identifier: MIT
// The two ways in which a machine shares out a scene and the work on it, and the steps from one to the other, each of
// which can be taken alone. No picture depends on them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace torolux {

enum class Scheme : std::uint8_t {
  /// Copies of what is hot on every PE, points and tiles dealt to whoever has little work, empty subspaces stepped
  /// over.
  spread,
  /// As the method was published: an owner shoots, every face between PEs is a hand-over to the adjacent one.
  paper,
};
inline constexpr std::array<std::string_view, 2> kSchemeNames = {"spread", "paper"};

/// Who expands a shot's points into records.
enum class Points : std::uint8_t {
  travel,  ///< whoever has little work
  stay,    ///< the patch's owner
};
inline constexpr std::array<std::string_view, 2> kPointsNames = {"travel", "stay"};

/// What a ray does at a subspace with nothing in it.
enum class Empty : std::uint8_t {
  over,   ///< whoever follows it goes on; nobody holds such a subspace
  enter,  ///< it goes to the owner, as if something were there
};
inline constexpr std::array<std::string_view, 2> kEmptyNames = {"over", "enter"};

/// Who makes the camera rays.
enum class RayMaker : std::uint8_t {
  pes,  ///< of tiles, dealt to whoever has little work
  host,
};
inline constexpr std::array<std::string_view, 2> kRayMakerNames = {"pes", "host"};

constexpr std::string_view name_of(Scheme scheme) {
  return kSchemeNames[static_cast<std::size_t>(scheme)];
}
constexpr std::string_view name_of(Points points) {
  return kPointsNames[static_cast<std::size_t>(points)];
}
constexpr std::string_view name_of(Empty empty) {
  return kEmptyNames[static_cast<std::size_t>(empty)];
}
constexpr std::string_view name_of(RayMaker maker) {
  return kRayMakerNames[static_cast<std::size_t>(maker)];
}

/// What a scheme has where nothing is said.
constexpr Points points_of(Scheme scheme) {
  return scheme == Scheme::paper ? Points::stay : Points::travel;
}
constexpr Empty empty_of(Scheme scheme) {
  return scheme == Scheme::paper ? Empty::enter : Empty::over;
}
constexpr RayMaker camera_rays_of(Scheme scheme) {
  return scheme == Scheme::paper ? RayMaker::host : RayMaker::pes;
}
constexpr const char* allocation_of(Scheme scheme) {
  return scheme == Scheme::paper ? "skewed" : "balanced";
}
/// All allocations, as messages name them.
inline constexpr std::string_view kAllocations =
    "skewed, skewed:AB (A, B two of x, y, z), skewed-both, modulo, block, balanced";

/// Most of a PE's memory for copies of subspaces, 0..1; absent: what fits.
constexpr std::optional<double> replicate_of(Scheme scheme) {
  return scheme == Scheme::paper ? std::optional(0.0) : std::nullopt;
}

}  // namespace torolux
