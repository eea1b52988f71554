// SPDX-License-Identifier: MIT
// Runs images as `torolux run` does, and keeps what it tells.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/run/run.hpp"

namespace torolux::test {

inline Image test_image(const std::string& name) {
  return load_image(std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (name + ".elf"));
}

struct Told {
  std::vector<std::string> lines;  ///< "PE @ time: text"
  MachineFigures figures;
  std::string failure;  ///< of the machine; "": none
};

inline MachineSetup small_setup(const std::string& engine, unsigned columns, unsigned rows, unsigned threads = 2) {
  MachineSetup setup;
  setup.engine = engine;
  setup.columns = columns;
  setup.rows = rows;
  setup.threads = threads;
  setup.local_memory_bytes = protocol::kSmallestLocalMemory;
  setup.description.processor.most_cycles_between_hints = 1'000'000;
  return setup;
}

inline Told tell(const MachineSetup& setup, const ImageSet& images,
                 const std::function<void(const Machine&)>& at_end = {}) {
  Told told;
  const auto hear = [&](const PeText& text) {
    told.lines.push_back(std::to_string(text.pe) + " @ " + std::to_string(text.time) + ": " + text.text);
  };
  try {
    told.figures = run_image(setup, images, hear, {}, at_end);
  } catch (const MachineFailure& failure) {
    told.failure = failure.what();
  }
  return told;
}

/// "FILE:LINE" of the only line of a test image's source that holds `text`.
inline std::string line_with(const std::string& file, const std::string& text) {
  std::ifstream source(std::filesystem::path(TOROLUX_SOURCE_DIR) / file);
  std::string found;
  std::string line;
  for (int number = 1; std::getline(source, line); ++number) {
    if (line.find(text) != std::string::npos) found += file + ":" + std::to_string(number);
  }
  return found;
}

}  // namespace torolux::test
