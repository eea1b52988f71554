// SPDX-License-Identifier: MIT
// From the frame buffer's integers to layers: units, means, what stands for nothing, and which element is meant.
#include "host_tools/render/frame_layers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux::test {
namespace {

using protocol::Plane;
using protocol::plane_bit;

class FrameLayersTest : public testing::Test {
 protected:
  FrameLayersTest() {
    const Scene scene = room_with_box();
    setup_.mesh = make_mesh(scene, {.patch_length = 0.4, .element_length = 0.2});
    setup_.units = light_units(scene, setup_.mesh, false);
    setup_.parameters.pixel_scale = 0x1p40F;
    frame_.width = 2;
    frame_.height = 1;
  }

  /// The layer made of two pixels' sums.
  Layer layer(Plane plane, const PixelSums& first, const PixelSums& second) {
    setup_.parameters.layers = plane_bit(plane);
    frame_.planes[static_cast<std::size_t>(plane)] = {first, second};
    const std::vector<Layer> layers = layers_of(frame_, setup_);
    EXPECT_EQ(layers.size(), 1U);
    EXPECT_EQ(layers.at(0).plane, plane);
    return layers.at(0);
  }

  RenderSetup setup_;
  FrameBuffer frame_;
};

constexpr std::int64_t kOneUnit = std::int64_t{1} << 24U;

TEST_F(FrameLayersTest, ColoursAreRadiance) {
  frame_.planes[0] = {{std::int64_t{1} << 40U, 0, 0}, {0, std::int64_t{1} << 41U, 0}};
  const Picture picture = picture_of(frame_, setup_);
  EXPECT_EQ(picture.width, 2U);
  EXPECT_FLOAT_EQ(picture.pixels[0][0], static_cast<float>(setup_.units.unit_radiance));
  EXPECT_FLOAT_EQ(picture.pixels[1][1], static_cast<float>(2 * setup_.units.unit_radiance));
}

/// Of four samples that a pixel may have, one had two, the other all.
TEST_F(FrameLayersTest, EachPixelIsDividedByItsOwnSamples) {
  setup_.parameters.pixel_samples = 4;
  frame_.planes[0] = {{std::int64_t{1} << 39U, 0, 0}, {std::int64_t{1} << 40U, 0, 0}};
  const Picture picture = picture_of(frame_, setup_, {2, 4});
  EXPECT_FLOAT_EQ(picture.pixels[0][0], picture.pixels[1][0]);
  EXPECT_FLOAT_EQ(picture.pixels[0][0], static_cast<float>(setup_.units.unit_radiance));
}

TEST_F(FrameLayersTest, IrradianceIsPiTimesTheSum) {
  const Layer of = layer(Plane::irradiance, {std::int64_t{1} << 40U, 0, 0}, {});
  EXPECT_FLOAT_EQ(of.values[0][0], static_cast<float>(std::numbers::pi * setup_.units.unit_radiance));
  EXPECT_EQ(of.values[1], (std::array<float, 3>{0, 0, 0}));
}

TEST_F(FrameLayersTest, DepthIsTheMeanInSceneUnits) {
  const Layer of = layer(Plane::depth, {3 * kOneUnit / 4, 3, 0}, {});
  EXPECT_FLOAT_EQ(of.values[0][0], static_cast<float>(0.25 / setup_.mesh.space.scale));
  EXPECT_TRUE(std::isinf(of.values[1][0])) << "no sample met anything";
}

TEST_F(FrameLayersTest, NormalsHaveLengthOne) {
  const Layer of = layer(Plane::normals, {3 * kOneUnit, 0, -4 * kOneUnit}, {});
  EXPECT_FLOAT_EQ(of.values[0][0], 0.6F);
  EXPECT_FLOAT_EQ(of.values[0][2], -0.8F);
  EXPECT_EQ(of.values[1], (std::array<float, 3>{0, 0, 0}));
}

TEST_F(FrameLayersTest, ElementsHaveTheirGlobalNumbers) {
  const Mesh& mesh = setup_.mesh;
  const MeshPatch& patch = mesh.patches[mesh.parts[mesh.triangles[3].first_part].patch];
  ASSERT_NE(patch.first_element[0], protocol::kNoSide);
  const MeshFacet& facet = mesh.facets[patch.first_facet + patch.facets - 1];
  const Layer of = layer(Plane::elements, {3 + 1, facet.code, 0}, {});
  EXPECT_EQ(of.numbers[0], patch.first_element[0] + facet.element);
  EXPECT_EQ(of.numbers[1], kNoNumber) << "nothing met";
  EXPECT_EQ(layer(Plane::elements, {3 + 1, 0, 0}, {}).numbers[0], kNoNumber) << "no elements there";
}

TEST_F(FrameLayersTest, OwnersAndCostsAreNumbers) {
  EXPECT_EQ(layer(Plane::owner, {6, 0, 0}, {}).numbers, (std::vector<std::uint32_t>{5, kNoNumber}));
  EXPECT_EQ(layer(Plane::cost, {77, 0, 0}, {}).numbers, (std::vector<std::uint32_t>{77, 0}));
  EXPECT_LT(layer(Plane::cost, {std::int64_t{1} << 40U, 0, 0}, {}).numbers[0], kNoNumber);
}

TEST_F(FrameLayersTest, ComeInTheOrderOfTheirNames) {
  setup_.parameters.layers = plane_bit(Plane::cost) | plane_bit(Plane::depth);
  for (const Plane plane : {Plane::cost, Plane::depth}) frame_.planes[static_cast<std::size_t>(plane)].resize(2);
  const std::vector<Layer> layers = layers_of(frame_, setup_);
  ASSERT_EQ(layers.size(), 2U);
  EXPECT_EQ(layers[0].plane, Plane::depth);
  EXPECT_EQ(layers[1].plane, Plane::cost);
}

}  // namespace
}  // namespace torolux::test
