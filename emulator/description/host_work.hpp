// SPDX-License-Identifier: MIT
// What a host program computes, by item: the machine description gives each its cycles of the host's processor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace torolux {

enum class HostWork : std::uint8_t {
  message,              ///< one taken in or made: interrupt, driver, descriptor
  copy,                 ///< 64 bytes between a message and the host's own memory
  entry,                ///< an entry of the program's lists: candidate, shooter looked at, grant, credits
  compare,              ///< two candidates in the sort, and their way in it
  camera_ray,           ///< made and put into a packet, its walk not counted
  subspace,             ///< entered on a camera ray's walk to the first that is filled
  layout,               ///< 64 bytes of a PE's stores laid out
  unpack,               ///< 64 bytes read back, put where they belong
  irradiance_triangle,  ///< its share of vertex irradiance, by its plan: sums at vertices, borders, its own three
                        ///< values
  irradiance_fit,       ///< at a vertex of a curved surface that is one patch: to all elements near it
  filter_entry,         ///< of the pixel filter's table
  hemicube_entry,       ///< of the hemi-cube's table
  count
};
inline constexpr std::size_t kHostWorks = static_cast<std::size_t>(HostWork::count);

/// Names of the keys in the machine file's table [host.cycles].
inline constexpr std::array<std::string_view, kHostWorks> kHostWorkNames = {
    "message",        "copy",         "entry",
    "compare",        "camera_ray",   "subspace",
    "layout",         "unpack",       "irradiance_triangle",
    "irradiance_fit", "filter_entry", "hemicube_entry"};

/// Bytes that are one item of copy, layout and unpack: a cache line.
inline constexpr std::uint64_t kHostLineBytes = 64;
constexpr std::uint64_t host_lines(std::uint64_t bytes) {
  return (bytes + kHostLineBytes - 1) / kHostLineBytes;
}

}  // namespace torolux
