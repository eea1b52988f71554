// SPDX-License-Identifier: MIT
// The dense solution against theory and the path tracer.
#include "tests/references/dense_radiosity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host_tools/mesh/retriangulate.hpp"
#include "tests/references/path_tracer.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::references {
namespace {

struct Dense {
  Scene scene;
  std::vector<DenseElement> elements;
  Eigen::MatrixXd form_factors;
};

Dense dense(const char* name, double length, const FormFactorChoice& choice) {
  Dense result{load_scene(test::data_dir() / "scenes" / name, {}), {}, {}};
  retriangulate(result.scene);  // as the mesh has it
  result.elements = dense_elements(result.scene, make_mesh(result.scene, {length, length, false}), false);
  result.form_factors = dense_form_factors(result.elements, World(result.scene, false), choice);
  return result;
}

/// A closed convex room: rows add up to one, and what i sends to j is what j would send to i.
TEST(DenseRadiosity, FormFactorsAddUpToOneAndAreReciprocal) {
  const Dense room = dense("lamp_room", 0.75, {});
  ASSERT_EQ(room.elements.size(), 62U);  // its outside, too, which sees nothing
  for (Eigen::Index i = 0; i < room.form_factors.rows(); ++i) {
    const bool outside = (Vec::Constant(0.5) - room.elements[static_cast<std::size_t>(i)].corner[0])
                             .dot(room.elements[static_cast<std::size_t>(i)].normal) < 0;
    EXPECT_NEAR(room.form_factors.row(i).sum(), outside ? 0 : 1, 1e-9) << i;
    for (Eigen::Index j = 0; j < i; ++j) {
      const double there = room.elements[static_cast<std::size_t>(i)].area * room.form_factors(i, j);
      const double back = room.elements[static_cast<std::size_t>(j)].area * room.form_factors(j, i);
      // Quadrature's error: of neighbours at an edge, 0.3 % of this, falling with the square of the cells.
      EXPECT_NEAR(there, back, 6e-5) << i << ' ' << j;
    }
  }
}

/// Radiance 1 emitted, one half reflected: B = 2 pi everywhere.
TEST(DenseRadiosity, FurnaceIsEmissionOverAbsorption) {
  const Dense furnace = dense("furnace", 0.75, {});
  for (const Colour& radiosity : dense_radiosities(furnace.elements, furnace.form_factors)) {
    for (Eigen::Index c = 0; c < 3; ++c) EXPECT_NEAR(radiosity[c], 2 * std::numbers::pi, 1e-7);
  }
}

/// With and without a post in the way, the light on each wall is that of the path tracer, up to what constant elements
/// cannot hold.
TEST(DenseRadiosity, IsThatOfThePathTracer) {
  for (const char* name : {"lamp_room", "post_room"}) {
    const bool post = name[0] == 'p';
    const Dense room = dense(name, 0.4, {post ? 1U : 2U, post ? 16U : 0U});
    const auto irradiances = dense_irradiances(room.form_factors, dense_radiosities(room.elements, room.form_factors));
    const World world(room.scene, false);
    std::vector<std::array<double, 2>> flux(room.scene.materials.size());  // dense, traced; all channels
    for (std::size_t i = 0; i < room.elements.size(); ++i) {
      const DenseElement& element = room.elements[i];
      auto& of_material = flux[room.scene.triangles[element.triangle].material];
      of_material[0] += element.area * irradiances[i].sum();
    }
    constexpr std::uint32_t kPaths = 1U << 13U;
    for (std::uint32_t t = 0; t < world.triangles().size(); ++t) {
      Samples samples(1, t);
      Colour sum = Colour::Zero();
      for (std::uint32_t i = 0; i < kPaths; ++i) {
        samples.begin(i);
        const auto [u, v] = samples.pair(0);
        const double root = std::sqrt(u);
        sum += incident_over_pi(world, world.at(t, root * (1 - v), root * v, true), LightFinding::both, samples);
      }
      flux[world.triangles()[t].material][1] += sum.sum() / kPaths * std::numbers::pi * world.triangles()[t].area;
    }
    for (std::size_t m = 0; m < flux.size(); ++m) {
      // The lamp sees no light but by way of others, at 1.1 % when elements are half as long: the rest is below 0.6 %.
      const bool lamp = room.scene.materials[m].emission[0] > 0;
      EXPECT_NEAR(flux[m][0] / flux[m][1], 1, lamp ? 0.04 : 0.01) << name << ' ' << room.scene.materials[m].name;
    }
  }
}

}  // namespace
}  // namespace torolux::references
