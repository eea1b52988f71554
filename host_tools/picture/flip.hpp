// SPDX-License-Identifier: MIT
// FLIP: how much of a difference a person sees who looks at one picture and then at the other in its place. Two
// pictures enter; a value 0..1 for each pixel leaves.
//
// P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astrom, M. D. Fairchild: FLIP: A Difference Evaluator
// for Alternating Images, Proc. ACM Computer Graphics and Interactive Techniques 3(2), 2020; for radiance:
// P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Moeller: Visualizing Errors in Rendered High Dynamic Range Images,
// Eurographics Short Papers 2021. Section numbers and symbols in flip.cpp are theirs.
#pragma once

#include "host_tools/picture/picture.hpp"
#include "host_tools/picture/plane.hpp"

namespace torolux {

/// A display of 3840 pixels over 0.7 m, seen from 0.7 m.
inline constexpr double kPixelsPerDegree = 67;
/// Beyond this filters reach over more pixels than are worth their time.
inline constexpr double kMostPixelsPerDegree = 1000;

/// Of pictures as they are shown: linear display values 0..1 (what is beyond is cut off). Same size, not empty,
/// pixels_per_degree > 0.
Plane flip(const Picture& shown, const Picture& reference, double pixels_per_degree);

/// Of pictures of radiance, shown at so many exposures that everything from the reference's brightest pixel to its
/// median luminance is once well exposed, with the tone curve of the paper; the largest value of each pixel. A black
/// reference: as it is, without exposure. Same size, not empty.
Plane hdr_flip(const Picture& picture, const Picture& reference, double pixels_per_degree);

struct Pooled {
  double mean = 0;
  double percentile_95 = 0;  ///< 95 % of the pixels are not above it
  double worst = 0;
  std::uint32_t worst_x = 0;
  std::uint32_t worst_y = 0;  ///< row, 0 on top
};

/// Not empty.
Pooled pool(const Plane& plane);

}  // namespace torolux
