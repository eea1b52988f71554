// SPDX-License-Identifier: MIT
// Closed factors from the points of a rule of degree 5 (Radon 1948) to whole elements, times the share that rays find
// visible; then LU factors for each channel.
#include "tests/references/dense_radiosity.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "firmware/protocol/triangle_grid.hpp"
#include "tests/references/form_factors.hpp"
#include "tests/references/random.hpp"

namespace torolux::references {
namespace {

/// A rule of degree 5 on the triangle (Radon 1948): weights of corners 0 and 1, and of the point.
struct RulePoint {
  double a, b, weight;
};
constexpr double kNear = 0.101286507323456;
constexpr double kMiddle = 0.470142064105115;
constexpr double kNearWeight = 0.125939180544827;
constexpr double kMiddleWeight = 0.132394152788506;
constexpr std::array<RulePoint, 7> kRule = {{{1.0 / 3, 1.0 / 3, 0.225},
                                             {kNear, kNear, kNearWeight},
                                             {kNear, 1 - 2 * kNear, kNearWeight},
                                             {1 - 2 * kNear, kNear, kNearWeight},
                                             {kMiddle, kMiddle, kMiddleWeight},
                                             {kMiddle, 1 - 2 * kMiddle, kMiddleWeight},
                                             {1 - 2 * kMiddle, kMiddle, kMiddleWeight}}};

struct WeightedPoint {
  Vec point;
  double b1, b2;  ///< weights of the element's corners 1 and 2
  double weight;  ///< all add up to one
};

Vec point_at(const DenseElement& element, double b1, double b2) {
  return element.corner[0] * (1 - b1 - b2) + element.corner[1] * b1 + element.corner[2] * b2;
}

/// The rule in each of cells^2 like triangles of the element.
std::vector<WeightedPoint> points_of(const DenseElement& element, unsigned cells) {
  std::vector<WeightedPoint> points;
  const double unit = 1.0 / cells;
  for (unsigned row = 0; row < cells; ++row) {
    for (unsigned column = 0; column < 2 * (cells - row) - 1; ++column) {
      const bool inverted = column % 2 == 1;
      const double b1 = ((column + 1) >> 1U) * unit;
      const double b2 = (row + (inverted ? 1 : 0)) * unit;
      for (const RulePoint& rule : kRule) {
        const double u = b1 + (inverted ? -rule.a : rule.a) * unit;
        const double v = b2 + (inverted ? -rule.b : rule.b) * unit;
        points.push_back({point_at(element, u, v), u, v, rule.weight / (cells * cells)});
      }
    }
  }
  return points;
}

bool any_in_front(const DenseElement& of, const DenseElement& element) {
  for (const Vec& corner : element.corner) {
    if ((corner - of.corner[0]).dot(of.normal) > 1e-12) return true;
  }
  return false;
}

/// Fraction of the element that a point sees, each part of it by its own share of the factor.
double visible_share(const World& world, const DenseElement& from, const Vec& point, const DenseElement& to,
                     unsigned rays, Samples& samples) {
  double seen = 0;
  double all = 0;
  const Vec origin = world.leave({from.triangle, 0, 0, true, point}, from.normal);
  for (unsigned ray = 0; ray < rays; ++ray) {
    samples.begin(ray);
    const auto [u, v] = samples.pair(0);
    const double root = std::sqrt(u);
    const Vec target = point_at(to, root * (1 - v), root * v);
    const Vec way = target - point;
    const double cosines = way.dot(from.normal) * -way.dot(to.normal);
    if (way.dot(from.normal) <= 0 || cosines <= 0) continue;
    const double weight = cosines / (way.squaredNorm() * way.squaredNorm());
    all += weight;
    if (!world.blocked(origin, target, from.triangle, to.triangle)) seen += weight;
  }
  return all > 0 ? seen / all : 0;
}

DenseElement dense_element(const Scene& scene, const MeshTriangle& triangle, const MeshFacet& facet, bool back,
                           bool emits) {
  const SceneMaterial& material = scene.materials[triangle.material];
  const protocol::GridTriangle grid = protocol::grid_triangle_of(facet.code);
  DenseElement element;
  for (std::size_t i = 0; i < 3; ++i) {
    Vec point = Vec::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      point += vec(scene.positions[triangle.position[k]]) *
               std::ldexp(static_cast<double>(grid.corner[i][k]), -int{protocol::kMostLevels});
    }
    element.corner[back ? 2 - i : i] = point;
  }
  const Vec across = (element.corner[1] - element.corner[0]).cross(element.corner[2] - element.corner[0]);
  element.normal = across.normalized();
  element.area = across.norm() / 2;
  element.diffuse = colour(material.diffuse);
  element.emitted = emits ? Colour(colour(material.emission) * std::numbers::pi) : Colour::Zero();
  element.triangle = facet.triangle;
  return element;
}

}  // namespace

std::vector<DenseElement> dense_elements(const Scene& scene, const Mesh& mesh, bool two_sided_lights) {
  if (mesh.triangles.size() != scene.triangles.size()) throw std::invalid_argument("the mesh left out a triangle");
  std::vector<DenseElement> elements(mesh.elements);
  for (const MeshTriangle& triangle : mesh.triangles) {
    if (scene.materials[triangle.material].kind != SurfaceKind::diffuse) {
      throw std::invalid_argument("the dense solution is for diffuse scenes");
    }
  }
  for (const MeshPatch& patch : mesh.patches) {
    if (patch.facets != patch.elements) throw std::invalid_argument("the dense solution knows no elements of pieces");
    for (std::uint32_t e = 0; e < patch.elements; ++e) {
      const MeshFacet& facet = mesh.facets[patch.first_facet + e];
      for (std::size_t side = 0; side < 2; ++side) {
        if (patch.side[side] == protocol::kNoSide) continue;
        elements.at(patch.first_element[side] + e) =
            dense_element(scene, mesh.triangles[facet.triangle], facet, side == 1, side == 0 || two_sided_lights);
      }
    }
  }
  return elements;
}

Eigen::MatrixXd dense_form_factors(const std::vector<DenseElement>& elements, const World& world,
                                   const FormFactorChoice& choice) {
  const auto n = static_cast<Eigen::Index>(elements.size());
  Eigen::MatrixXd factors = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const DenseElement& from = elements[static_cast<std::size_t>(i)];
    const auto points = points_of(from, choice.cells);
    for (Eigen::Index j = 0; j < n; ++j) {
      const DenseElement& to = elements[static_cast<std::size_t>(j)];
      if (!any_in_front(from, to) || !any_in_front(to, from)) continue;
      for (std::size_t p = 0; p < points.size(); ++p) {
        double factor = point_to_polygon(points[p].point, from.normal, to.corner);
        if (factor <= 0) continue;  // below the surface, or seen from its other side
        if (choice.visibility_rays > 0) {
          Samples samples(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j) * points.size() + p);
          factor *= visible_share(world, from, points[p].point, to, choice.visibility_rays, samples);
        }
        factors(i, j) += points[p].weight * factor;
      }
    }
  }
  return factors;
}

std::vector<Colour> dense_radiosities(const std::vector<DenseElement>& elements, const Eigen::MatrixXd& form_factors) {
  const auto n = static_cast<Eigen::Index>(elements.size());
  std::vector<Colour> radiosities(elements.size(), Colour::Zero());
  for (Eigen::Index c = 0; c < 3; ++c) {
    Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd emitted(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const DenseElement& element = elements[static_cast<std::size_t>(i)];
      system.row(i) -= element.diffuse[c] * form_factors.row(i);
      emitted[i] = element.emitted[c];
    }
    const Eigen::VectorXd solution = system.partialPivLu().solve(emitted);
    for (Eigen::Index i = 0; i < n; ++i) radiosities[static_cast<std::size_t>(i)][c] = solution[i];
  }
  return radiosities;
}

std::vector<Colour> dense_irradiances(const Eigen::MatrixXd& form_factors, const std::vector<Colour>& radiosities) {
  std::vector<Colour> irradiances(radiosities.size(), Colour::Zero());
  for (std::size_t i = 0; i < radiosities.size(); ++i) {
    for (std::size_t j = 0; j < radiosities.size(); ++j) {
      irradiances[i] += form_factors(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * radiosities[j];
    }
  }
  return irradiances;
}

}  // namespace torolux::references
