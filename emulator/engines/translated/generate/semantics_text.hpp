// SPDX-License-Identifier: MIT
// The headers of semantics/ as text: translated code is compiled with them where there is no source tree.
#pragma once

#include <string>
#include <vector>

namespace torolux::translated {

/// A file: its path as #include names it (or for a translation unit, its name), and what is in it.
struct SourceText {
  std::string name;
  std::string text;
};

std::vector<SourceText> semantics_texts();

}  // namespace torolux::translated
