// SPDX-License-Identifier: MIT
// Pictures of whole scenes against the path tracer.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/accuracy/reference_pictures.hpp"

namespace torolux::accuracy {

struct PictureReportChoice {
  std::vector<std::filesystem::path> scenes;
  std::vector<std::string> settings;  ///< names of kSettings; empty: all
  std::string engine = "native";
  ReferenceEffort reference;
  unsigned threads = 0;          ///< of this computer
  std::filesystem::path output;  ///< folder
};

/// Renders every scene at every setting; writes pictures.csv, pictures.md and, for each scene, its reference, the
/// product's pictures and their differences. Scenes without light get the studio.
void report_pictures(const PictureReportChoice& choice);

}  // namespace torolux::accuracy
