// SPDX-License-Identifier: MIT
// Form factors that are known in closed form: shapes in; the fraction of the light that diffuse shape 1 sends and shape
// 2 receives, nothing between them, out.
//
// Numbers like C-11 are those of J. R. Howell, "A Catalog of Radiation Heat Transfer Configuration Factors". Lengths
// are in one unit, all above zero.
#pragma once

#include <span>

#include "tests/references/world.hpp"

namespace torolux::references {

/// C-11: from a rectangle a x b to the same one opposite, at distance c.
double opposite_rectangles(double a, double b, double c);

/// C-14: from a rectangle of width w to one of height h, square to it; their common edge has length l.
double rectangles_at_an_edge(double w, double h, double l);

/// C-41: from a disc of radius r1 to one of radius r2 on the same axis, parallel to it, at distance h.
double coaxial_discs(double r1, double r2, double h);

/// Sides along the axes of a plane.
struct Rectangle {
  double x0, x1, y0, y1;  ///< x0 < x1, y0 < y1
};

/// C-13 (Ehlert & Smith 1993, "View factors for perpendicular and parallel rectangular plates"): from one rectangle to
/// another in the parallel plane at distance z, anywhere there.
double parallel_rectangles(const Rectangle& from, const Rectangle& to, double z);

/// C-15 (the same): from a rectangle in the plane z = 0, its x above zero, to one in the plane x = 0, whose Rectangle's
/// x is the height z, above zero; y is the same axis in both.
double perpendicular_rectangles(const Rectangle& from, const Rectangle& to);

/// From a point of a surface with this unit normal to a polygon, anywhere; what of it is below the surface does not
/// count. J. H. Lambert, Photometria (1760): the sum over the edges of the angle that each spans times the cosine of
/// its plane's normal, over 2 pi. Corners counter-clockwise as seen from the point count positive.
double point_to_polygon(const Vec& point, const Vec& normal, std::span<const Vec> corners);

}  // namespace torolux::references
