// SPDX-License-Identifier: MIT
// Irradiances of both, element by element and channel by channel; leaves: their relative RMSE, weighted by area, and
// the worst element.
#include "tests/support/dense_errors.hpp"

#include <cmath>

#include "host_tools/mesh/retriangulate.hpp"
#include "tests/references/dense_radiosity.hpp"

namespace torolux::test {

DenseErrors dense_errors(const SolvedScene& solved, unsigned visibility_rays) {
  Scene scene = solved.scene;
  retriangulate(scene);  // as the mesh has it
  const auto elements = references::dense_elements(scene, solved.mesh, false);
  const auto factors = references::dense_form_factors(elements, references::World(scene, false), {3, visibility_rays});
  const auto should = references::dense_irradiances(factors, references::dense_radiosities(elements, factors));
  double difference = 0;
  double square = 0;
  DenseErrors errors{0, 0, 0, 0};
  for (std::uint32_t e = 0; e < elements.size(); ++e) {
    if (should[e].maxCoeff() > 0) ++errors.elements;
    const auto flux = solved.incident_flux(e);
    for (std::size_t c = 0; c < 3; ++c) {
      const double is = flux[c] / elements[e].area;
      const double expected = should[e][static_cast<Eigen::Index>(c)];
      difference += elements[e].area * (is - expected) * (is - expected);
      square += elements[e].area * expected * expected;
      if (!(expected > 0) || std::fabs(is / expected - 1) <= errors.worst) continue;
      errors.worst = std::fabs(is / expected - 1);
      errors.worst_element = e;
    }
  }
  errors.rmse = std::sqrt(difference / square);
  return errors;
}

}  // namespace torolux::test
