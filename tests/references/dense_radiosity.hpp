// SPDX-License-Identifier: MIT
// The radiosity equation solved as one system, for small scenes: elements and their form factors in; radiosities out.
//
// Elements are those of the product's mesh, each side one, with constant radiosity: so the product's solution differs
// only by its sampling, and not by what elements can represent, where its patches are its elements.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "host_tools/mesh/mesh.hpp"
#include "tests/references/world.hpp"

namespace torolux::references {

struct DenseElement {
  std::array<Vec, 3> corner;  ///< counter-clockwise seen from this side
  Vec normal;                 ///< unit, of this side
  double area;                ///< [user units^2]
  Colour diffuse;             ///< reflectance
  Colour emitted;             ///< pi * Ke [W/m^2], 0 on a back that does not emit
  std::uint32_t triangle;     ///< of the scene
};

/// By global element number (Mesh::elements). Throws std::invalid_argument where the scene has a mirror or glass, or
/// the mesh left out a triangle.
std::vector<DenseElement> dense_elements(const Scene& scene, const Mesh& mesh, bool two_sided_lights);

struct FormFactorChoice {
  unsigned cells = 4;            ///< each element is cut into cells^2 triangles, with 7 points in each
  unsigned visibility_rays = 0;  ///< from each point to each element; 0: nothing stands between elements
};

/// F(i, j): of what element i sends, what j receives. At each point of i exact by point_to_polygon, so that rows of a
/// closed scene add up to one; visibility, where asked for, by rays to well spread points of j.
Eigen::MatrixXd dense_form_factors(const std::vector<DenseElement>& elements, const World& world,
                                   const FormFactorChoice& choice);

/// B [W/m^2] by element: B_i = emitted_i + diffuse_i * sum over j of F(i, j) B_j, solved for each channel.
std::vector<Colour> dense_radiosities(const std::vector<DenseElement>& elements, const Eigen::MatrixXd& form_factors);

/// What falls on each element [W/m^2].
std::vector<Colour> dense_irradiances(const Eigen::MatrixXd& form_factors, const std::vector<Colour>& radiosities);

}  // namespace torolux::references
