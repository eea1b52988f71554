// SPDX-License-Identifier: MIT
// MGF's c, cxy, cspec, cct and cmix enter; the current colour leaves.
#pragma once

#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/mgf_contexts.hpp"

namespace torolux {

class MgfColours {
 public:
  /// Throws InputError: a colour that is not defined, or that no light has (negative brightness, outside of x + y = 1).
  void handle(const MgfStatement& statement);
  const Chromaticity& current() { return colours_.current(); }

  static bool knows(std::string_view keyword);

 private:
  static Chromaticity spectrum(const MgfStatement& statement);
  Chromaticity mixture(const MgfStatement& statement);

  MgfContexts<Chromaticity> colours_{"colour"};
};

}  // namespace torolux
