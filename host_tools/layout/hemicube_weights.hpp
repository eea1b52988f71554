// SPDX-License-Identifier: MIT
// The pixels along a hemi-cube's edge enter; its table leaves: exact delta form factors, rounded so that they add up to
// one exactly.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/protocol/hemicube_bends.hpp"

namespace torolux {

/// Form factor from a small area at the origin, facing +z, to the rectangle [0, x] x [0, y] at height 1; x, y >= 0.
double top_form_factor(double x, double y);
/// The same to the rectangle [0, x] x height [0, z] of the side face at distance 1.
double side_form_factor(double x, double z);

/// hemicube_weights(n) fractions of 2^32, in the order that protocol/stores.hpp gives; n even, 2..kMostHemicubeSize.
/// 4 * sum(top) + 8 * sum(side) == 2^32.
std::vector<std::uint32_t> make_hemicube_weights(std::uint32_t n);
/// These with the bends of their pixels: the table as the PEs have it.
std::vector<protocol::HemicubeEntry> make_hemicube_table(std::uint32_t n);

}  // namespace torolux
