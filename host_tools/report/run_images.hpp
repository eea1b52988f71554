// SPDX-License-Identifier: MIT
// The files of firmware that a run of `torolux run` takes in, and which PE runs which.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/files/digest.hpp"

namespace torolux {

struct RunImages {
  RunImages() = default;
  /// Every PE runs this one.
  RunImages(InputFile file) { files.push_back(std::move(file)); }  // NOLINT(google-explicit-constructor)

  std::vector<InputFile> files;           ///< none twice; at least one
  std::vector<std::uint32_t> file_of_pe;  ///< place in `files`, by PE; empty: the only one

  /// Where there are several: of one of them, the PEs that run it, ascending.
  std::vector<unsigned> pes_of(std::uint32_t file) const;
  /// The paths as they were named, or only the files' names, with commas between them.
  std::string paths() const;
  std::string names() const;
};

}  // namespace torolux
