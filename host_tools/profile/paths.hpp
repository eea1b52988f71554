// SPDX-License-Identifier: MIT
// The profiles of PEs enter; one tree of call paths leaves, by the functions' names, with waits as frames of their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "emulator/profile/cycle_profile.hpp"

namespace torolux {

using NameNumber = std::uint32_t;

/// As they stand in every output, by WaitReason.
inline constexpr std::array<std::string_view, kWaitReasons> kWaitFrames = {
    "[waits: receive]", "[waits: torus queue full]", "[waits: bus queue full]", "[waits: copy engine]"};

/// The names in a profile: those of waits, then those of functions. Functions of one name are one.
class ProfileNames {
 public:
  explicit ProfileNames(const profile::CycleProfile& profile);

  const std::vector<std::string>& all() const { return names_; }
  /// Of a function of the PE.
  NameNumber of(const profile::PeProfile& pe, profile::FunctionNumber function) const;

 private:
  std::vector<std::string> names_;
  std::map<const profile::FunctionTable*, std::vector<NameNumber>> of_table_;
};
constexpr bool is_wait(NameNumber name) {
  return name < kWaitReasons;
}

struct Path {
  std::size_t parent;   ///< index of a path before this one; of the first: 0
  NameNumber name;      ///< of the first, which is all paths together: none
  std::uint64_t calls;  ///< of a wait: 0
  std::uint64_t self;   ///< [cycles]
  std::uint64_t total;  ///< [cycles] with all that it has called
};

/// A path, then all that begin with it, the costliest first.
struct PathTree {
  std::vector<Path> paths;
  bool cut = false;  ///< of some paths, functions have been left out

  std::uint64_t cycles() const { return paths.front().total; }
};

/// Of these PEs together; each less than profile.pes().
PathTree paths_of(const profile::CycleProfile& profile, const ProfileNames& names, std::span<const unsigned> pes);

}  // namespace torolux
