// SPDX-License-Identifier: MIT
// IMAGE and --image: which PE runs which firmware. Options enter; files with their digests, and loaded images leave.
#pragma once

#include <string>
#include <vector>

#include "emulator/engines/image/image_set.hpp"
#include "host_tools/report/run_images.hpp"

namespace CLI {
class App;
}

namespace torolux {

struct ImageOptions {
  struct OfPes {
    std::vector<unsigned> pes;  ///< ascending
    std::string file;
  };
  std::string others;         ///< of all PEs that `of_pes` does not name; empty: none
  std::vector<OfPes> of_pes;  ///< in the order given
};

void add_image_options(CLI::App& command, ImageOptions& options);

/// Whether `of_pes` names all: then nobody needs `others`.
bool names_each_pe(const ImageOptions& options, unsigned pes);

/// A file that is named twice, by whatever path, is one. Throws UsageError: a PE without an image, or with two;
/// InputError: a PE that is not in the machine, a file that cannot be read.
RunImages images_of(const ImageOptions& options, unsigned pes);

/// Throws InputError.
ImageSet load_images(const RunImages& images);

}  // namespace torolux
