// SPDX-License-Identifier: MIT
// This computer's C++ compiler: translation units in, a shared object out.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "emulator/engines/translated/generate/semantics_text.hpp"

namespace torolux::translated {

class HostCompiler {
 public:
  /// Looks for g++, clang++ and c++ on PATH. Throws MachineFailure where there is none.
  HostCompiler();

  /// All that the result depends on beside the sources: the compiler's name and version, and its options.
  const std::string& identity() const { return identity_; }

  /// headers: lie in `folder` (existing, empty) under their names; units become one shared object, whose path is
  /// returned. As many compilers run at once as the computer has cores; all that they write lies in `folder`. stop:
  /// asked again and again, null: never. Throws MachineFailure with what they wrote, and when it is to stop: then none
  /// of them runs any more.
  std::filesystem::path build(std::span<const SourceText> headers, std::span<const SourceText> units,
                              const std::filesystem::path& folder, const std::function<bool()>& stop = {}) const;

 private:
  std::vector<std::string> command(const std::filesystem::path& folder) const;

  std::string program_;
  std::string identity_;
  bool is_gcc_ = false;
};

}  // namespace torolux::translated
