// SPDX-License-Identifier: MIT
// The text of a measured lamp (IESNA LM-63-1986, -1991, -1995, -2002, and -2019 where it is alike) enters; its web of
// intensities and the size of its opening leave. docs/scenes.md says how it is read.
#pragma once

#include <string>
#include <string_view>

#include "host_tools/scene/notices.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

struct MeasuredLamp {
  LampWeb web;
  std::array<double, 2> flux{0, 0};  ///< below and above the horizon [W], 179 lumens each; together above 0
  double length = 0, width = 0;      ///< of the opening, along the turns of 0 and of 90 degrees [m], above 0
  bool round = false;                ///< a disc: both are its diameter
};

/// Throws InputError with file and line: no TILT= line, a word that is no number or out of its range, angles that do
/// not rise or do not span what type C has, photometry of types A and B, an end before the last intensity, no light,
/// decimal commas.
MeasuredLamp read_ies(std::string_view text, const std::string& file, Notices& notices);

}  // namespace torolux
