// SPDX-License-Identifier: MIT
// Ray against triangle, watertight: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", Journal of
// Computer Graphics Techniques 2(1), 2013. Edges are inclusive: a ray at an edge meets both neighbours, and none is
// lost.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "firmware/pe/traverse.hpp"
#include "firmware/pe/vectors.hpp"
#include "firmware/pe/walk.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

/// What the test needs of a ray, computed once: axes permuted so that z is the longest, and the shear that lays the ray
/// on it.
struct Shear {
  Shear(const glm::vec3& from, const glm::vec3& along, const Inverse& inverse) {
    const protocol::Vec3f o = to_array(from);
    const protocol::Vec3f d = to_array(along);
    const auto size = [&](std::size_t a) { return bits(d[a]) & 0x7FFF'FFFF; };
    z = size(1) > size(0) ? 1 : 0;
    if (size(2) > size(z)) z = 2;
    x = z == 2 ? 0 : z + 1;
    y = x == 2 ? 0 : x + 1;
    if (bits(d[z]) < 0) std::swap(x, y);  // keeps the triangle's winding
    scale = inverse.axis[z];
    shear_x = d[x] * scale;
    shear_y = d[y] * scale;
    origin_x = o[x];
    origin_y = o[y];
    origin_z = o[z];
  }
  std::size_t x, y, z;
  float origin_x, origin_y, origin_z;
  float shear_x, shear_y, scale;
};

/// Where a ray's line meets a triangle: weights of corners 0, 1, 2 times `sum`, and the distance. Front: sum > 0.
struct Crossing {
  float u, v, w, sum;
  float t;
};

/// The edge functions where one of them is zero in float: their exact signs. Returns false if they differ.
inline bool resolve_edges(float ax, float ay, float bx, float by, float cx, float cy, Crossing& out) {
  const auto edge = [](float px, float qy, float py, float qx) {
    return static_cast<float>(static_cast<double>(px) * static_cast<double>(qy) -
                              static_cast<double>(py) * static_cast<double>(qx));
  };
  out.u = edge(cx, by, cy, bx);
  out.v = edge(ax, cy, ay, cx);
  out.w = edge(bx, ay, by, ax);
  const bool below = out.u < 0.0F || out.v < 0.0F || out.w < 0.0F;
  const bool above = out.u > 0.0F || out.v > 0.0F || out.w > 0.0F;
  return below != above;
}

/// The test. Most triangles are missed: what can be told from signs comes first. A call would cost 9 % of a radiosity
/// record.
[[gnu::always_inline]] inline bool cross_triangle(const Shear& ray, const protocol::Polygon& polygon, Crossing& out) {
  const auto& a = polygon.corner[0];
  const auto& b = polygon.corner[1];
  const auto& c = polygon.corner[2];
  const std::size_t x = ray.x;
  const std::size_t y = ray.y;
  const std::size_t z = ray.z;
  const float az = a[z] - ray.origin_z;
  const float bz = b[z] - ray.origin_z;
  const float cz = c[z] - ray.origin_z;
  const float ax = (a[x] - ray.origin_x) - ray.shear_x * az;
  const float bx = (b[x] - ray.origin_x) - ray.shear_x * bz;
  const float cx = (c[x] - ray.origin_x) - ray.shear_x * cz;
  if (strictly_one_side(bits(ax), bits(bx), bits(cx))) return false;
  const float ay = (a[y] - ray.origin_y) - ray.shear_y * az;
  const float by = (b[y] - ray.origin_y) - ray.shear_y * bz;
  const float cy = (c[y] - ray.origin_y) - ray.shear_y * cz;
  if (strictly_one_side(bits(ay), bits(by), bits(cy))) return false;

  out.u = cx * by - cy * bx;
  out.v = ax * cy - ay * cx;
  out.w = bx * ay - by * ax;
  const std::int32_t u = bits(out.u);
  const std::int32_t v = bits(out.v);
  const std::int32_t w = bits(out.w);
  if ((u << 1) == 0 || (v << 1) == 0 || (w << 1) == 0) {
    if (!resolve_edges(ax, ay, bx, by, cx, cy, out)) return false;
  } else if (((u ^ v) | (u ^ w)) < 0) {
    return false;
  }
  out.sum = (out.u + out.v) + out.w;
  if ((bits(out.sum) << 1) == 0) return false;
  out.t = ((out.u * az + out.v * bz) + out.w * cz) * ray.scale / out.sum;
  return true;
}

/// The box of the part of a ray that lies in one subspace, in parts of that. A hit that counts lies in it (to some 1e-6
/// of rounding; the polygons' boxes are grown by a hundred times that).
class Reach {
 public:
  /// scale: Scene::box_scale.
  Reach(const glm::vec3& origin, const glm::vec3& direction, const Inverse& inverse, const protocol::Vec3f& scale)
      : origin_(origin * to_vector(scale)), direction_(direction * to_vector(scale)), inverse_(inverse) {}

  /// Between these distances, in the cell where the walk is: what protocol::boxes_apart compares with.
  std::uint32_t box(const Walk& walk, float t_in, float t_out) {
    const Parts begin = bits(t_in) == bits(last_t_) ? last_ : at(t_in);
    last_ = at(t_out);
    last_t_ = t_out;
    std::uint32_t packed = protocol::kBoxRayFlips;
    packed ^= of_axis<0>(begin.x, last_.x, walk.cell_along(0));
    packed ^= of_axis<1>(begin.y, last_.y, walk.cell_along(1));
    packed ^= of_axis<2>(begin.z, last_.z, walk.cell_along(2));
    return packed;
  }

 private:
  /// Counted from the lowest corner of the object space; modulo 2^32 where a ray begins far outside.
  struct Parts {
    std::uint32_t x, y, z;
  };
  /// What is no number, or beyond all integers, becomes whatever the processor makes of it: no ray of a scene's begins
  /// that far away, and for others only which polygons are tested depends on it.
  __attribute__((no_sanitize("float-cast-overflow"))) static std::uint32_t part(float x) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(x));
  }
  Parts at(float t) const {
    return {part(origin_.x + direction_.x * t), part(origin_.y + direction_.y * t), part(origin_.z + direction_.z * t)};
  }
  template <std::uint32_t kAxis>
  std::uint32_t of_axis(std::uint32_t begin, std::uint32_t end, std::uint32_t cell) const {
    const auto in_cell = [first = cell * protocol::kBoxParts](std::uint32_t part) {
      const std::uint32_t local = part - first;
      if (local < protocol::kBoxParts) return local;
      return static_cast<std::int32_t>(local) < 0 ? 0 : protocol::kBoxParts - 1U;
    };
    const std::uint32_t low = in_cell(inverse_.upward[kAxis] ? begin : end);
    const std::uint32_t high = in_cell(inverse_.upward[kAxis] ? end : begin);
    return (high | low << protocol::kBoxUpperShift) << (kAxis * protocol::kBoxAxisShift);
  }

  glm::vec3 origin_, direction_;
  const Inverse& inverse_;
  Parts last_{};
  float last_t_ = -1.0F;  ///< where last_ is
};

/// t: the crossing's. polygon: index of the one that was crossed.
inline Hit hit_of(const Crossing& crossing, float t, std::uint32_t polygon) {
  const float inverse = 1.0F / crossing.sum;
  return {t, crossing.v * inverse, crossing.w * inverse, polygon, crossing.sum > 0.0F};
}

}  // namespace torolux::pe
