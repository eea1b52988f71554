// SPDX-License-Identifier: MIT
// How far a picture is from its reference, in the measure by which the product is judged: two pictures in, numbers out.
// Written apart from host_tools/picture/compare.hpp, so that each checks the other.
#pragma once

#include "host_tools/picture/picture.hpp"
#include "tests/references/path_tracer.hpp"

namespace torolux::references {

struct PictureError {
  double clamp;       ///< 97th percentile of all channel values of the reference; both pictures are cut off there
  double mean;        ///< mean of the picture / mean of the reference - 1, both clamped
  double plain_mean;  ///< the same, not clamped
  double rmse;  ///< sqrt(mean square difference of 4x4-pixel block means / mean square of the reference's), clamped
};

/// Same size, not empty, reference not black.
PictureError picture_error(const Picture& picture, const Picture& reference);

/// What of such an rmse the reference's own noise makes: half the rmse between its halves.
double reference_noise(const TracedPicture& reference);

}  // namespace torolux::references
