// SPDX-License-Identifier: MIT
// Closed integrals, summed over the corners of two rectangles; for a point and a polygon the angles of its edges, once
// it is clipped at the point's horizon.
#include "tests/references/form_factors.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

namespace torolux::references {
namespace {

constexpr double kPi = std::numbers::pi;

/// Sum of (-1)^(i + j + k + l) G(x_i, y_j, xi_k, eta_l) over the corners of two rectangles.
template <class Function>
double over_corners(const Rectangle& from, const Rectangle& to, Function g) {
  double sum = 0;
  for (unsigned corners = 0; corners < 16; ++corners) {
    const double x = (corners & 1U) != 0 ? from.x1 : from.x0;
    const double y = (corners & 2U) != 0 ? from.y1 : from.y0;
    const double xi = (corners & 4U) != 0 ? to.x1 : to.x0;
    const double eta = (corners & 8U) != 0 ? to.y1 : to.y0;
    const bool odd = ((corners ^ corners >> 1U ^ corners >> 2U ^ corners >> 3U) & 1U) != 0;
    sum += (odd ? -1 : 1) * g(x, y, xi, eta);
  }
  return sum / (2 * kPi * (from.x1 - from.x0) * (from.y1 - from.y0));
}

/// The polygon's part above the plane through the origin with this normal (Sutherland & Hodgman 1974).
std::vector<Vec> above(const std::vector<Vec>& corners, const Vec& normal) {
  std::vector<Vec> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec& a = corners[i];
    const Vec& b = corners[(i + 1) % corners.size()];
    const double height_a = a.dot(normal);
    const double height_b = b.dot(normal);
    if (height_a >= 0) kept.push_back(a);
    if ((height_a > 0 && height_b < 0) || (height_a < 0 && height_b > 0)) {
      kept.emplace_back(a + (b - a) * (height_a / (height_a - height_b)));
    }
  }
  return kept;
}

}  // namespace

double opposite_rectangles(double a, double b, double c) {
  const double x = a / c;
  const double y = b / c;
  const double xx = std::sqrt(1 + x * x);
  const double yy = std::sqrt(1 + y * y);
  return 2 / (kPi * x * y) *
         (std::log(xx * yy / std::sqrt(1 + x * x + y * y)) + x * yy * std::atan(x / yy) + y * xx * std::atan(y / xx) -
          x * std::atan(x) - y * std::atan(y));
}

double rectangles_at_an_edge(double w, double h, double l) {
  const double ww = w * w / (l * l);
  const double hh = h * h / (l * l);
  const double diagonal = std::sqrt(ww + hh);
  const double all = 1 + ww + hh;
  const double logs = std::log((1 + ww) * (1 + hh) / all) + ww * std::log(ww * all / ((1 + ww) * (ww + hh))) +
                      hh * std::log(hh * all / ((1 + hh) * (hh + ww)));
  return (w / l * std::atan(l / w) + h / l * std::atan(l / h) - diagonal * std::atan(1 / diagonal) + logs / 4) /
         (kPi * w / l);
}

double coaxial_discs(double r1, double r2, double h) {
  const double x = 1 + (h * h + r2 * r2) / (r1 * r1);
  return (x - std::sqrt(x * x - 4 * (r2 / r1) * (r2 / r1))) / 2;
}

double parallel_rectangles(const Rectangle& from, const Rectangle& to, double z) {
  return over_corners(from, to, [z](double x, double y, double xi, double eta) {
    const double u = x - xi;
    const double v = y - eta;
    const double uz = std::hypot(u, z);
    const double vz = std::hypot(v, z);
    return v * uz * std::atan(v / uz) + u * vz * std::atan(u / vz) - z * z / 2 * std::log(u * u + v * v + z * z);
  });
}

double perpendicular_rectangles(const Rectangle& from, const Rectangle& to) {
  return over_corners(from, to, [](double x, double y, double xi, double eta) {
    const double v = y - eta;
    const double r2 = x * x + xi * xi;
    const double r = std::sqrt(r2);
    const double angle = r > 0 ? v * r * std::atan(v / r) : 0;
    const double all = r2 + v * v;
    return angle - (all > 0 ? (r2 - v * v) / 4 * std::log(all) : 0);
  });
}

double point_to_polygon(const Vec& point, const Vec& normal, std::span<const Vec> corners) {
  std::vector<Vec> ways;
  for (const Vec& corner : corners) ways.emplace_back(corner - point);
  ways = above(ways, normal);
  double sum = 0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const Vec& a = ways[i];
    const Vec& b = ways[(i + 1) % ways.size()];
    const Vec across = a.cross(b);
    const double sine = across.norm();
    if (sine > 0) sum += std::atan2(sine, a.dot(b)) * across.dot(normal) / sine;
  }
  return -sum / (2 * kPi);
}

}  // namespace torolux::references
