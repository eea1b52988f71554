// SPDX-License-Identifier: MIT
// Proves: of a triangle exactly those points are left over which the mask is there, wound as before; the parts of
// neighbours meet in the same positions; and a picture's alpha or map_d does that to faces.
#include "host_tools/scene/cut_out.hpp"

#include <random>

#include "tests/unit/host_tools/scene/texture_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;
using Points = std::array<std::array<double, 2>, 3>;

CutOutMask mask(std::uint32_t width, const std::vector<bool>& there) {
  return {width, static_cast<std::uint32_t>(there.size()) / width, there};
}

double determinant(const CutOutPart& p) {
  return p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) - p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
         p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
}

/// Of the triangle's area: that of a part is the determinant of its corners' weights.
double left_over(const std::vector<CutOutPart>& parts) {
  double sum = 0;
  for (const CutOutPart& part : parts) sum += determinant(part);
  return sum;
}

const Points kUnit{{{0, 0}, {1, 0}, {0, 1}}};

TEST(CutOut, AllThereIsNotCut) {
  EXPECT_FALSE(cut_out(mask(2, {true, true, true, true}), kUnit).has_value());
  EXPECT_FALSE(cut_out(mask(4, {true, true, false, false}), {{{0.1, 0}, {0.4, 0}, {0.1, 0.9}}}).has_value());
  EXPECT_TRUE(cut_out(mask(1, {false}), kUnit).value().empty());
}

TEST(CutOut, HalfIsLeft) {
  // Left half of the unit square: 3/4 of its lower left triangle.
  EXPECT_NEAR(left_over(cut_out(mask(2, {true, false}), kUnit).value()), 0.75, 1e-12);
  EXPECT_NEAR(left_over(cut_out(mask(2, {false, true}), kUnit).value()), 0.25, 1e-12);
}

TEST(CutOut, PointsWithoutAreaShowOneCell) {
  const CutOutMask two = mask(2, {true, false});
  EXPECT_FALSE(cut_out(two, {{{0.2, 0}, {0.2, 0}, {0.2, 0}}}).has_value() &&
               cut_out(two, {{{0.2, 0}, {0.2, 0}, {0.2, 0}}})->empty());
  EXPECT_TRUE(cut_out(two, {{{0.7, 0}, {0.7, 0}, {0.7, 0}}}).value().empty());
}

TEST(CutOut, TooManyRepeatsAreRefused) {
  EXPECT_THROW(cut_out(mask(2, {true, false}), {{{0, 0}, {1e4, 0}, {0, 1e4}}}), std::length_error);
  EXPECT_THROW(cut_out(mask(2, {true, false}), {{{1e300, 0}, {1e300, 0}, {1e300, 1}}}), std::length_error);
}

/// Weights of a point in a part, all >= 0 where it is inside.
bool inside(const CutOutPart& part, const CutOutCorner& p) {
  for (std::size_t i = 0; i < 3; ++i) {
    CutOutPart replaced = part;
    replaced[i] = p;
    if (determinant(replaced) < 0) return false;
  }
  return true;
}

TEST(CutOut, IsTheMaskPointForPoint) {
  std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same every time
  const auto number = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  for (int trial = 0; trial < 200; ++trial) {
    CutOutMask any{1 + static_cast<std::uint32_t>(random() % 7), 1 + static_cast<std::uint32_t>(random() % 7), {}};
    for (std::uint32_t i = 0; i < any.width * any.height; ++i) any.there.push_back(random() % 2 == 0);
    Points points{};
    for (auto& point : points) point = {number(-2, 2), number(-2, 2)};
    const auto parts = cut_out(any, points);
    for (int sample = 0; parts && sample < 50; ++sample) {
      CutOutCorner w{number(0, 1), number(0, 1), number(0, 1)};
      const double sum = w[0] + w[1] + w[2];
      std::array<double, 2> cell{0, 0};
      for (std::size_t i = 0; i < 3; ++i) w[i] /= sum;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t axis = 0; axis < 2; ++axis)
          cell[axis] += w[i] * points[i][axis] * (axis == 0 ? any.width : any.height);
      // Too near to an edge to tell.
      if (std::abs(cell[0] - std::round(cell[0])) < 1e-6 || std::abs(cell[1] - std::round(cell[1])) < 1e-6) continue;
      const auto wrapped = [](double value, std::uint32_t period) {
        return static_cast<std::uint32_t>(std::floor(value) - period * std::floor(std::floor(value) / period));
      };
      const bool there = any.there[wrapped(cell[1], any.height) * any.width + wrapped(cell[0], any.width)];
      const auto covered = std::ranges::count_if(*parts, [&w](const CutOutPart& part) { return inside(part, w); });
      EXPECT_EQ(covered, there ? 1 : 0) << "trial " << trial;
    }
    for (std::size_t i = 0; parts && i < parts->size(); ++i)
      EXPECT_GT(determinant((*parts)[i]), 0) << "wound otherwise";
  }
}

TEST(CutOut, FineImagesAreAveraged) {
  std::vector<std::uint8_t> alpha(std::size_t{256} * 128, 0);
  for (std::size_t i = 0; i < alpha.size(); i += 256)
    std::fill_n(alpha.begin() + static_cast<std::ptrdiff_t>(i), 128, 255);
  const CutOutMask halved = cut_out_mask(alpha, 256, 128);
  EXPECT_EQ(halved.width, kMostMaskEdge);
  EXPECT_EQ(halved.height, kMostMaskEdge);
  for (std::size_t i = 0; i < halved.there.size(); ++i)
    EXPECT_EQ(halved.there[i], i % kMostMaskEdge < kMostMaskEdge / 2);
  EXPECT_EQ(cut_out_mask(std::vector<std::uint8_t>{127, 128}, 2, 1).there, (std::vector<bool>{false, true}));
}

/// A unit square whose texture points are its corners; its material has this image.
Texts card(const std::string& statements, const std::string& image) {
  return {{"a.obj",
           "mtllib a.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
           "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"},
          {"a.mtl", "newmtl m\nKd 0.5 0.5 0.5\n" + statements},
          {"leaf.png", image}};
}

double whole_area(const Scene& scene) {
  double sum = 0;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) sum += area(scene, i);
  return sum;
}

/// 4 x 4, there but for the four in the middle.
std::string frame_image() {
  std::array<std::array<std::uint8_t, 4>, 16> pixels{};
  for (std::size_t i = 0; i < 16; ++i) {
    const bool hole = i % 4 % 3 != 0 && i / 4 % 3 != 0;
    pixels[i] = {200, 100, 50, static_cast<std::uint8_t>(hole ? 40 : 255)};
    if (hole) pixels[i][0] = 0;
  }
  return png(4, 4, pixels.data(), PNG_FORMAT_RGBA);
}

TEST(CutOut, AlphaOfATextureLeavesAHole) {
  const Scene scene = load_texts(card("map_Kd leaf.png\n", frame_image()), "a.obj");
  EXPECT_NEAR(whole_area(scene), 0.75, 1e-7);  // positions are floats
  EXPECT_THAT(scene.warnings, Contains(StartsWith("a.mtl:3: the alpha of a texture cuts its faces out")));
  EXPECT_EQ(scene.textures[0].texels[5], (std::array<std::uint8_t, 3>{200, 100, 50})) << "what is hidden has no colour";
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d& at = scene.positions[scene.triangles[t].position[i]];
      const auto& uv = scene.texture_points[scene.triangles[t].texture_points + i];
      EXPECT_NEAR(uv[0], at[0], 1e-6);
      EXPECT_NEAR(uv[1], at[1], 1e-6);
    }
  }
  // Along the diagonal both sides meet in the same positions: nobody stands there with one neighbour alone.
  std::map<std::uint32_t, int> sides;
  for (const SceneTriangle& triangle : scene.triangles) {
    Vec3d middle{0, 0, 0};
    for (const std::uint32_t p : triangle.position)
      for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] += scene.positions[p][axis] / 3;
    for (const std::uint32_t p : triangle.position)
      if (scene.positions[p][0] == scene.positions[p][1]) sides[p] |= middle[0] > middle[1] ? 1 : 2;
  }
  EXPECT_EQ(sides.size(), 4U) << "0, 1/4, 3/4, 1";
  for (const auto& [position, both] : sides) EXPECT_EQ(both, 3) << position;
}

TEST(CutOut, NeighboursMeetHoweverTheyAreTurned) {
  Texts turned = card("map_Kd -s 3.3 2.7 leaf.png\n", frame_image());
  const std::size_t upright = load_texts(turned, "a.obj").positions.size();
  turned["s.toml"] = "[[mesh]]\nfile = 'a.obj'\nrotate = [10, 20, 30]\nscale = 0.37\n";
  EXPECT_EQ(load_texts(turned, "s.toml").positions.size(), upright);
}

TEST(CutOut, MapDLeavesAHoleWithoutATexture) {
  const std::array<std::uint8_t, 4> grey{255, 100, 255, 255};
  const std::string image = png(2, 2, grey.data(), PNG_FORMAT_GRAY);
  const Scene scene = load_texts(card("map_d leaf.png\n", image), "a.obj");
  EXPECT_NEAR(whole_area(scene), 0.75, 1e-7);
  EXPECT_THAT(scene.warnings, Contains(StartsWith("a.mtl:3: map_d cuts faces out")));
  EXPECT_TRUE(scene.textures.empty());
  EXPECT_NEAR(whole_area(load_texts(card("map_d -s 3 3 leaf.png\n", image), "a.obj")), 0.75, 1e-7) << "repeated";
  EXPECT_NEAR(whole_area(load_texts(card("map_d leaf.png\n", frame_image()), "a.obj")), 0.75, 1e-7) << "by its alpha";
  EXPECT_NEAR(whole_area(load_texts(card("illum 7\nNi 1.5\nmap_d leaf.png\n", image), "a.obj")), 1, 1e-12) << "glass";
  EXPECT_NEAR(whole_area(load_texts(card("illum 3\nKs 0.9\nmap_d leaf.png\n", image), "a.obj")), 0.75, 1e-7);
  EXPECT_THAT(refusal(card("map_d gone.png\n", image), "a.obj"), StartsWith("a.mtl:3: there is no texture 'gone.png'"));
  EXPECT_NEAR(whole_area(load_texts(card("map_d -mm 0 2 leaf.png\n", image), "a.obj")), 1, 1e-12) << "100 becomes 200";
  EXPECT_NEAR(whole_area(load_texts(card("map_d -mm 0.3 1 leaf.png\n", image), "a.obj")), 1, 1e-12);
  EXPECT_THAT(refusal(card("map_d -mm 0 0.4 leaf.png\n", image), "a.obj"), HasSubstr("no surface"));
}

// 200, 100, 50 and there, but for the four in the middle: 0, 100, 50 and not there.
TEST(CutOut, MapDByAChannel) {
  const std::array<std::pair<const char*, double>, 5> left{{{"r", 0.75}, {"g", 0}, {"b", 0}, {"l", 0}, {"m", 0.75}}};
  for (const auto& [channel, area] : left) {
    const std::string line = std::string("map_d -imfchan ") + channel + " leaf.png\n";
    Texts texts = card(line, frame_image());
    texts["a.obj"] += "v 0 0 9\nv 1 0 9\nv 0 1 9\nusemtl white\nf -3 -2 -1\n";  // what is left of all is a surface
    texts["a.mtl"] += "newmtl white\nKd 1 1 1\n";
    EXPECT_NEAR(whole_area(load_texts(texts, "a.obj")), area + 0.5, 1e-7) << channel;
  }
  EXPECT_THAT(refusal(card("map_d -imfchan z leaf.png\n", frame_image()), "a.obj"), HasSubstr("r, g, b, l and m"));
}

TEST(CutOut, FrontsNormalsAndFlipsStay) {
  Texts mirror = card("illum 3\nKs 0.9\nmap_d leaf.png\n", frame_image());
  mirror["a.obj"] =
      "mtllib a.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl m\nvn 0 0 1\nvn 0.6 0 0.8\nv 0 0 0\nv 1 0 0\nv 1 1 0\n"
      "f 1/1/1 2/2/2 3/3/2\n";
  mirror["s.toml"] = "[[mesh]]\nfile = 'a.obj'\nflip = true\n";
  for (const char* name : {"a.obj", "s.toml"}) {
    const Scene scene = load_texts(mirror, name);
    EXPECT_GT(scene.triangles.size(), 1U);
    for (const SceneTriangle& triangle : scene.triangles) {
      ASSERT_NE(triangle.normal[0], kNoNormal) << "they agree with the front, or they would have been left out";
      for (std::size_t i = 0; i < 3; ++i) {
        const double x = scene.positions[triangle.position[i]][0];
        const Vec3d& n = scene.normals[triangle.normal[i]];
        EXPECT_NEAR(std::abs(n[0] / n[2]), 0.6 * x / (1 - 0.2 * x), 1e-6) << "interpolated";
      }
    }
  }
}

TEST(CutOut, AlphaThatIsZeroEverywhereIsNone) {
  const std::array<std::uint8_t, 4> unset{9, 9, 9, 0};
  const Scene scene = load_texts(card("map_Kd leaf.png\n", png(1, 1, unset.data(), PNG_FORMAT_RGBA)), "a.obj");
  EXPECT_EQ(scene.triangles.size(), 2U);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("alpha of a texture is zero everywhere and not used")));
}

}  // namespace
}  // namespace torolux
