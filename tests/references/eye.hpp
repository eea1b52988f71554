// SPDX-License-Identifier: MIT
// The product's camera, both ways: a place in the picture to a direction, and a point in the scene to its pixel.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>

#include "host_tools/scene/camera.hpp"
#include "tests/references/path_tracer.hpp"

namespace torolux::references {

/// Pixels are squares, all samples in one of equal weight.
class Eye {
 public:
  Eye(const Camera& camera, const TraceChoice& choice)
      : width_(choice.width), height_(choice.height), eye_(vec(camera.eye)) {
    forward_ = (vec(camera.look_at) - eye_).normalized();
    right_ = forward_.cross(vec(camera.up)).normalized();
    half_ = std::tan(camera.field_of_view_degrees / 2 * std::numbers::pi / 180);
    lens_right_ = right_ * camera.aperture / 2;
    lens_down_ = forward_.cross(right_) * camera.aperture / 2;
    focus_ = focus_distance(camera);
    down_ = forward_.cross(right_) * half_;
    right_ *= half_ * width_ / height_;
  }
  const Vec& place() const { return eye_; }
  /// x rightwards, y downwards, in pixels.
  Vec direction(double x, double y) const {
    return (forward_ + (2 * x / width_ - 1) * right_ + (2 * y / height_ - 1) * down_).normalized();
  }

  /// Whether what is not in focus is blurred. see() knows of no lens.
  bool has_lens() const { return lens_right_.squaredNorm() > 0; }
  struct Ray {
    Vec origin, direction;
  };
  /// Through the lens's point of this turn (0..1 of a whole one) and at this share of its area from the middle (0..1).
  Ray ray(double x, double y, double turn, double share) const {
    const double angle = 2 * std::numbers::pi * turn;
    const Vec at = eye_ + std::sqrt(share) * (std::cos(angle) * lens_right_ + std::sin(angle) * lens_down_);
    const Vec way = direction(x, y);
    return {at, (eye_ + way * (focus_ / way.dot(forward_)) - at).normalized()};
  }

  struct Seen {
    std::size_t pixel;
    /// Its mean radiance for radiance 1 of the surface, per area of the surface that faces the eye [1/user units^2].
    double share;
  };
  /// Absent: outside the picture. What lies between is not asked.
  std::optional<Seen> see(const Vec& point) const {
    const Vec way = point - eye_;
    const double depth = way.dot(forward_);
    if (depth <= 0) return std::nullopt;
    const double x = (way.dot(right_) / (depth * right_.squaredNorm()) + 1) / 2 * width_;
    const double y = (way.dot(down_) / (depth * down_.squaredNorm()) + 1) / 2 * height_;
    if (!(x >= 0 && x < width_ && y >= 0 && y < height_)) return std::nullopt;
    // A pixel on the plane at distance 1, and how much of that plane a bit of solid angle covers.
    const double pixel_area = 4 * half_ * half_ / (height_ * height_);
    const double distance2 = way.squaredNorm();
    const double cosine = depth / std::sqrt(distance2);
    const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    return Seen{pixel, 1 / (distance2 * cosine * cosine * cosine * pixel_area)};
  }

 private:
  double width_, height_, half_, focus_ = 1;
  Vec eye_, forward_, right_, down_, lens_right_, lens_down_;
};

}  // namespace torolux::references
