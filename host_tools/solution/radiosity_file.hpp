// SPDX-License-Identifier: MIT
// Saved radiosities: the solution of a radiosity stage goes into a file, and comes back for other views of the same
// scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host_tools/solution/radiosity_origin.hpp"
#include "host_tools/solution/solution.hpp"

namespace torolux {

/// File: "TLXRAD" and version, CRC-32 and length of the rest, RadiosityOrigin, sums, splits, patch sides, elements;
/// little-endian.
std::vector<std::byte> pack_radiosity(const RadiosityOrigin& origin, std::span<const Split> splits,
                                      const Solution& solution);

/// What of a file can be told without the mesh, which its splits decide.
struct SavedRadiosity {
  std::string name;  ///< for messages
  RadiosityOrigin origin;
  std::vector<Split> splits;    ///< ascending
  std::vector<std::byte> rest;  ///< sums, patch sides, elements
};

/// Throws InputError: not such a file, another version, damaged, cut short. name: for messages.
SavedRadiosity parse_radiosity(std::span<const std::byte> bytes, const std::string& name);
/// Throws InputError: made from another scene or settings (which, and what to give). Before there is a mesh.
void check_radiosity(const SavedRadiosity& saved, const Scene& scene, const Quality& quality);
/// Throws InputError: made from another scene or settings, damaged.
Solution unpack_radiosity(const SavedRadiosity& saved, const RadiosityOrigin& expected, const Mesh& mesh);

/// Throws InputError where the file cannot be written; leaves none behind then.
void save_radiosity(const std::filesystem::path& file, const RadiosityOrigin& origin, std::span<const Split> splits,
                    const Solution& solution);
/// Throws InputError as parse_radiosity, and where the file cannot be read.
SavedRadiosity read_radiosity(const std::filesystem::path& file);

}  // namespace torolux
