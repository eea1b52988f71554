// SPDX-License-Identifier: MIT
// Streaks: how much of a picture's error lies along directions, as what long thin triangles and bands along edges leave
// does, and grain and round patches do not. Two pictures enter, numbers leave.
#pragma once

#include "host_tools/picture/picture.hpp"
#include "host_tools/picture/plane.hpp"

namespace torolux {

struct Streaks {
  /// RMS of the directed part of the error [L*: 0 black, 100 display white; 1 is about what can just be seen].
  double directed = 0;
  double error = 0;  ///< RMS of all of the error at the same scales [L*]
  double share = 0;  ///< of the error's energy, 0..1: directed^2 / error^2; 0 without error
};

/// Of pictures as they are shown: linear display values 0..1. The error is the difference in CIE lightness, taken apart
/// into bands of one octave each, of details of about 2 to 32 pixels. In each the structure tensor (W. Foerstner,
/// E. Guelch, 1987; J. Bigun, G. Granlund, 1987) says how well the error's slopes around a pixel agree in direction, by
/// its eigenvalues' coherence ((l1 - l2) / (l1 + l2))^2: 1 for stripes, 0 where none prevails. What equal noise would
/// have by chance is taken off. Same size, not empty.
Streaks streaks(const Picture& shown, const Picture& reference);

/// The same of an error alone [L*].
Streaks streaks(const Plane& error);

}  // namespace torolux
