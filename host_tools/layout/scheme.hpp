// SPDX-License-Identifier: MIT
// The two ways in which a machine shares out a scene and the work on it. No picture depends on it.
#pragma once

#include <array>
#include <cstdint>
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

constexpr std::string_view name_of(Scheme scheme) {
  return kSchemeNames[static_cast<std::size_t>(scheme)];
}

}  // namespace torolux
