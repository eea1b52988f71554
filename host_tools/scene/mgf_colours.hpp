// SPDX-License-Identifier: MIT
// MGF's c, cxy, cspec, cct and cmix enter; the current colour leaves.
#pragma once

#include <unordered_map>

#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/mgf_contexts.hpp"

namespace torolux {

class MgfColours {
 public:
  /// The text of the statement outlives this. Throws InputError: a colour that is not defined, or that no light has
  /// (negative brightness, outside of x + y = 1).
  void handle(const MgfStatement& statement);
  const Chromaticity& current() { return colours_.current(); }

  static bool knows(std::string_view keyword);

 private:
  static Chromaticity spectrum(const MgfStatement& statement);
  static Chromaticity temperature(const MgfStatement& statement);
  /// What a statement says by itself is worked out once, however often arrays repeat it.
  Chromaticity once(const MgfStatement& statement, Chromaticity (*work_out)(const MgfStatement&));
  Chromaticity mixture(const MgfStatement& statement);

  MgfContexts<Chromaticity> colours_{"colour"};
  std::unordered_map<const char*, Chromaticity> worked_out_;  ///< by where the statement's keyword stands
};

}  // namespace torolux
