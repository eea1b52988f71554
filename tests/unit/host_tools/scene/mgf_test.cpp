// SPDX-License-Identifier: MIT
// Proves how each entity of MGF is read: contexts, surfaces, transforms, includes; and that mistakes say where they
// are.
#include "host_tools/scene/mgf.hpp"
#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kQuad = "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nv d =\np 0 1 0\nm grey =\nrd .5\n";

Scene mgf(const std::string& text) {
  return load_texts({{"a.mgf", text}}, "a.mgf");
}
std::string refused(const std::string& text) {
  return refusal({{"a.mgf", text}}, "a.mgf");
}

vec::Box bounds(const Scene& scene) {
  vec::Box box;
  for (const Vec3d& p : scene.positions) box.include(p);
  return box;
}

void expect_box(const Scene& scene, const Vec3d& low, const Vec3d& high) {
  const vec::Box box = bounds(scene);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(box.low[i], low[i], 1e-9);
    EXPECT_NEAR(box.high[i], high[i], 1e-9);
  }
}

double whole_area(const Scene& scene) {
  double sum = 0;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) sum += area(scene, t);
  return sum;
}

Vec3d front(const Scene& scene, std::size_t t) {
  const auto& p = scene.triangles[t].position;
  const Vec3d& a = scene.positions[p[0]];
  return vec::unit(vec::cross(vec::subtract(scene.positions[p[1]], a), vec::subtract(scene.positions[p[2]], a)));
}

double volume(const Scene& scene) {
  double sum = 0;
  for (const SceneTriangle& t : scene.triangles)
    sum += vec::dot(scene.positions[t.position[0]],
                    vec::cross(scene.positions[t.position[1]], scene.positions[t.position[2]])) /
           6;
  return sum;
}

TEST(Mgf, FaceAndItsMaterial) {
  const Scene scene = mgf(kQuad + "f a b c d\n");
  EXPECT_EQ(scene.name, "a");
  ASSERT_EQ(scene.triangles.size(), 2U);
  EXPECT_EQ(front(scene, 0), (Vec3d{0, 0, 1}));
  EXPECT_DOUBLE_EQ(whole_area(scene), 1);
  EXPECT_EQ(scene.materials[0].name, "grey");
  EXPECT_NEAR(scene.materials[0].diffuse[1], 0.5, 1e-12);
}

TEST(Mgf, CommentsContinuationsAndBlanks) {
  const Scene scene = mgf("# a comment \\\n rd .9 of it\n \t" + kQuad + "\n\no thing\nf a \\\n  b c\\\r\n d\no\n");
  EXPECT_DOUBLE_EQ(whole_area(scene), 1);
  EXPECT_THAT(mgf(kQuad + "f a b c d # behind\n").warnings, Contains(StartsWith("a.mgf:11: a comment behind")));
}

TEST(Mgf, UnknownEntitiesAreToldAndPassedOver) {
  EXPECT_THAT(mgf(kQuad + "fancy 1 2\nf a b c d\n").warnings,
              Contains(HasSubstr("a.mgf:11: an entity that MGF does not have is passed over: 'fancy'")));
}

// The four forms of a context; unnamed ones always begin anew, and what has been used does not change any more.
TEST(Mgf, ContextsAreSelectedCopiedAndChanged) {
  const Scene scene =
      mgf(kQuad + "m other = grey\nrs .1 .2\nm grey\nf a b c d\nm other\nf d c b a\nrd .25\nxf -t 0 0 1\n" +
          "f a b c d\nm\nrd .125\nf d c b a\nm\nxf -t 0 0 1\nf a b c d\n");
  ASSERT_EQ(scene.materials.size(), 5U);
  EXPECT_FALSE(is_glossy(scene.materials[0]));
  EXPECT_NEAR(scene.materials[1].diffuse[0], 0.5, 1e-12);
  EXPECT_NEAR(scene.materials[1].specular[0], 0.1, 1e-12);
  EXPECT_EQ(scene.materials[2].name, "other");
  EXPECT_NEAR(scene.materials[2].diffuse[0], 0.25, 1e-12);
  EXPECT_EQ(scene.materials[3].name, "(none)");
  EXPECT_NEAR(scene.materials[3].diffuse[0], 0.125, 1e-12);
  EXPECT_EQ(scene.materials[4].diffuse[0], 0);  // a new unnamed one is black
}

// A vertex stands where it is when it is used; the transform at its definition does not matter (specification, v).
TEST(Mgf, VerticesAreMovedWhenTheyAreUsed) {
  const Scene scene = mgf("xf -t 5 0 0\nv v1 =\np 0 10 0\nn 0 0 1\nxf -rx 180\nm\nrd .5\nring v1 0 2\nxf\nxf\n");
  const vec::Box box = bounds(scene);
  EXPECT_NEAR(box.centre()[0], 5, 1e-9);
  EXPECT_NEAR(box.centre()[1], -10, 1e-9);
  EXPECT_NEAR(front(scene, 0)[2], -1, 1e-12);
}

TEST(Mgf, TransformsFollowEachOther) {
  expect_box(mgf(kQuad + "xf -t 1 0 0 -rz 90 -s 2\nf a b c d\nxf\n"), {-2, 2, 0}, {0, 4, 0});
  // What is inside comes first.
  expect_box(mgf(kQuad + "xf -t 10 0 0\nxf -s 3\nf a b c d\nxf\nxf\n"), {10, 0, 0}, {13, 3, 0});
  expect_box(mgf(kQuad + "xf -i 3 -t 1 0 0 -s 2 -i 1 -t 0 0 5\nf a b c d\nxf\n"), {14, 0, 5}, {22, 8, 5});
}

// Mirrored things keep their fronts: what looked to +z still does, or looks to -z where z is mirrored.
TEST(Mgf, MirrorsKeepFrontsOutwards) {
  EXPECT_EQ(front(mgf(kQuad + "xf -mx\nf a b c d\nxf\n"), 0), (Vec3d{0, 0, 1}));
  EXPECT_EQ(front(mgf(kQuad + "xf -mz\nf a b c d\nxf\n"), 0), (Vec3d{0, 0, -1}));
  EXPECT_EQ(front(mgf(kQuad + "xf -mx -mz\nf a b c d\nxf\n"), 0), (Vec3d{0, 0, -1}));
  EXPECT_GT(volume(mgf(kQuad + "xf -my\nprism a d c b 1\nsph a .2\nxf\n")), 0.9);
  EXPECT_GT(volume(mgf(kQuad + "xf -s -1\nprism a d c b 1\nxf\n")), 0.9);
}

// The specification's example: 60 spheres at a spacing of one in a 3 x 4 x 5 array that begins at (15, 30, 45).
TEST(Mgf, ArraysOfSeveralDimensions) {
  const Scene scene =
      mgf("v v0 =\np 0 0 0\nm\nrd .5\nxf -a 3 -t 1 0 0 -a 4 -t 0 1 0 -a 5 -t 0 0 1 -i 1 -t 15 30 45\n"
          "sph v0 0.1\nxf\n");
  EXPECT_EQ(scene.triangles.size() % 60, 0U);
  const vec::Box box = bounds(scene);
  EXPECT_NEAR(box.centre()[0], 16, 1e-9);
  EXPECT_NEAR(box.centre()[1], 31.5, 1e-9);
  EXPECT_NEAR(box.centre()[2], 47, 1e-9);
}

// Within an array everything is carried out anew for each copy, other arrays too.
TEST(Mgf, ArraysWithinArrays) {
  const Scene scene = mgf(kQuad + "xf -a 2 -t 0 0 1\nxf -a 3 -t 2 0 0\nf a b c d\nxf\nxf\n");
  EXPECT_DOUBLE_EQ(whole_area(scene), 6);
  expect_box(scene, {0, 0, 0}, {5, 1, 1});
}

TEST(Mgf, HolesAreLeftOut) {
  const std::string corners = kQuad + "v e =\np .25 .25 0\nv f =\np .5 .25 0\nv g =\np .5 .5 0\nv h =\np .25 .5 0\n" +
                              "v i =\np .6 .6 0\nv j =\np .8 .6 0\nv k =\np .7 .8 0\n";
  EXPECT_NEAR(whole_area(mgf(corners + "fh a b c d - e f g h\n")), 1 - 0.0625, 1e-12);
  EXPECT_NEAR(whole_area(mgf(corners + "fh a b c d - h g f e - i j k\n")), 1 - 0.0625 - 0.02, 1e-12);
  EXPECT_NEAR(whole_area(mgf(corners + "fh d c b a - i j k - e f g h\n")), 1 - 0.0625 - 0.02, 1e-12);
  EXPECT_EQ(front(mgf(corners + "fh a b c d - e f g h\n"), 0), (Vec3d{0, 0, 1}));
  // The same as a seam (specification, f).
  EXPECT_NEAR(whole_area(mgf(corners + "f a b c d h g f e h d\n")), 1 - 0.0625, 1e-12);
  EXPECT_THAT(refused(corners + "fh a b c - e f\n"), HasSubstr("a.mgf:25: an outline of fewer than three"));
}

// Many holes in a row, in columns, and one beside the next: no seam may cross another hole.
TEST(Mgf, ManyHoles) {
  std::string text = "v a =\np 0 0 0\nv b =\np 10 0 0\nv c =\np 10 10 0\nv d =\np 0 10 0\nm\nrd .5\n";
  std::string face = "fh a b c d";
  for (int x = 0; x < 9; ++x)
    for (int y = 0; y < 9; ++y) {
      const std::string name = "h" + std::to_string(10 * x + y);
      face += " -";
      const std::array<std::array<double, 2>, 4> corner{{{.3, .3}, {.9, .4}, {.8, .9}, {.4, .8}}};
      for (std::size_t i = 0; i < 4; ++i) {
        text += "v " + name + "." + std::to_string(i) + " =\np " + std::to_string(x + corner[i][0]) + " " +
                std::to_string(y + corner[i][1]) + " 0\n";
        face += " " + name + "." + std::to_string(i);
      }
    }
  const double shoelace = 0.5 * ((.3 * .4 - .9 * .3) + (.9 * .9 - .8 * .4) + (.8 * .8 - .4 * .9) + (.4 * .3 - .3 * .8));
  const Scene scene = mgf(text + face + "\n");
  EXPECT_NEAR(whole_area(scene), 100 - 81 * shoelace, 1e-9);
  EXPECT_THAT(scene.warnings, testing::Not(Contains(HasSubstr("crosses itself"))));
}

TEST(Mgf, SolidsLookOutwards) {
  const std::string ends = kQuad + "v top =\np 0 0 2\nn 0 0 1\nv low =\np 0 0 0\nn 0 0 -1\n";
  EXPECT_NEAR(volume(mgf(ends + "prism a d c b 1\n")), 1, 1e-9);
  EXPECT_NEAR(volume(mgf(ends + "prism a d c b -1\n")), -1, 1e-9);
  expect_box(mgf(ends + "prism a d c b 1\n"), {0, 0, 0}, {1, 1, 1});
  EXPECT_NEAR(volume(mgf(ends + "cyl low 1 top\nring low 0 1\nring top 0 1\n")), 2 * 3.14159, 0.1);
  EXPECT_NEAR(volume(mgf(ends + "cone low 1 top 0\nring low 0 1\n")), 2 * 3.14159 / 3, 0.05);
  EXPECT_LT(volume(mgf(ends + "sph a -1\n")), -3.5);
  EXPECT_NEAR(volume(mgf(ends + "torus top 1 2\n")), 2 * 9.8696 * 1.5 * 0.25, 0.2);
}

// A lamp of 1600 lumens stays one, although its triangles have less area than the sphere (specification, ed).
TEST(Mgf, CurvedLampsKeepTheirLumens) {
  const Scene scene = mgf("m\nc\ncct 3000\ned 87712\nv cent =\np 0 0 0\nsph cent .0381\n");
  double lumens = 0;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t)
    lumens +=
        179 * 3.14159265358979 * area(scene, t) * luminance(scene.materials[scene.triangles[t].material].emission);
  EXPECT_NEAR(lumens, 1600, 0.2);
}

TEST(Mgf, IncludesAreRelativeAndPlaced) {
  const Texts texts{{"d/a.mgf", kQuad + "i sub/b.inc -t 5 0 0 -a 2 -t 0 0 1\nf a b c d\n"},
                    {"d/sub/b.inc", "i c.inc\nm grey\nf a b c d\n"},
                    {"d/sub/c.inc", "v d =\np 0 2 0\n"}};
  const Scene scene = load_texts(texts, "d/a.mgf");
  // The vertex that the innermost file sets stays as it is: only transforms end with their file.
  expect_box(scene, {0, 0, 0}, {6, 2, 1});
  EXPECT_DOUBLE_EQ(whole_area(scene), 4.5);
  EXPECT_THAT(refusal({{"a.mgf", kQuad + "i b.inc\n"}}, "a.mgf"), HasSubstr("a.mgf:11: there is no file 'b.inc'"));
}

TEST(Mgf, FilesThatIncludeEachOtherAreRefused) {
  EXPECT_THAT(refused("i a.mgf\n"), HasSubstr("a.mgf:1: 'a.mgf' includes itself"));
  EXPECT_THAT(refusal({{"a.mgf", "i b.mgf\n"}, {"b.mgf", "\ni ./a.mgf\n"}}, "a.mgf"),
              HasSubstr("b.mgf:2: 'a.mgf' includes itself"));
}

TEST(Mgf, TransformsEndWithTheirFile) {
  const Texts texts{{"a.mgf", kQuad + "i b.inc\nf a b c d\n"}, {"b.inc", "xf -a 2 -t 0 0 1\nf a b c d\n"}};
  const Scene scene = load_texts(texts, "a.mgf");
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("b.inc: a transform (xf) that is not closed ends with its file")));
  expect_box(scene, {0, 0, 0}, {1, 1, 1});
  EXPECT_THAT(refusal({{"a.mgf", kQuad + "xf -s 2\ni b.inc\n"}, {"b.inc", "xf\n"}}, "a.mgf"),
              HasSubstr("b.inc:1: xf without arguments closes"));
}

TEST(Mgf, MistakesSayWhereTheyAre) {
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {"f a b\n", "a.mgf:11: 'f' has 2 arguments; it is written f VERTEX VERTEX VERTEX ..."},
      {"f a b x\n", "a.mgf:11: there is no vertex 'x' yet"},
      {"v e =\np 1 2\nf a b e\n", "a.mgf:12: 'p' is followed by three numbers"},
      {"v e =\np 1 2 z\nf a b e\n", "a.mgf:12: 'z' is not a number"},
      {"ring a 0 1\n", "a.mgf:11: vertex 'a' has no normal (n)"},
      {"cyl a 1 a\n", "a.mgf:11: both ends are one point"},
      {"cyl a 0 b\n", "a.mgf:11: both radii are zero"},
      {"cone a 1 b -1\n", "a.mgf:11: one radius is above and one below zero"},
      {"sph a 0\n", "a.mgf:11: a sphere without a radius"},
      {"v e =\nn 0 0 1\ntorus e 2 1\n", "a.mgf:13: the inner radius is 0 or more and below"},
      {"prism a b 1\n", "a.mgf:11: 'prism' has 3 arguments"},
      {"prism a b c 0\n", "a.mgf:11: a prism without a length"},
      {"xf -rw 1\n", "a.mgf:11: '-rw' is not a transform; allowed are -t X Y Z"},
      {"xf -t 1 2\n", "a.mgf:11: the transform ends too early"},
      {"xf -s 0\n", "a.mgf:11: a scale of zero"},
      {"xf -a 0 -t 1 0 0\n", "a.mgf:11: an array of no copies"},
      {"xf -a 1.5 -t 1 0 0\n", "a.mgf:11: '1.5' is not a whole number"},
      {"xf\n", "a.mgf:11: xf without arguments closes"},
      {"c red\n", "a.mgf:11: there is no colour 'red' yet"},
      {"cxy .8 .8\n", "a.mgf:11: no light has this colour"},
      {"cxy .3\n", "a.mgf:11: 'cxy' has 1 arguments; it is written cxy X Y"},
      {"cct 0\n", "a.mgf:11: the temperature must be 100 to 1e9 kelvin"},
      {"cspec 700 400 1 2\n", "a.mgf:11: the spectrum runs from 700 to 400 nm; it must run upwards"},
      {"cspec 100 200 1 2\n", "a.mgf:11: this colour has no brightness"},
      {"cmix 1\n", "a.mgf:11: a mixture is written"},
      {"v e = q\n", "a.mgf:11: there is no vertex 'q' yet"},
      {"v e is a\n", "a.mgf:11: the name is followed by 'is'; only '=' may stand there"},
      {"sides 3\n", "a.mgf:11: 'sides' is followed by 1 or 2"},
      {"rd 1.5\nf a b c\n", "a.mgf:11: 'rd' is 1.5; allowed are 0 to 1"},
      {"ed -1\nf a b c\n", "a.mgf:11: 'ed' is -1"},
      {"m undefined\nf a b c\n", "a.mgf:11: material 'undefined' is not defined in any material library"},
  };
  for (const auto& [text, message] : mistakes) EXPECT_THAT(refused(kQuad + text), StartsWith(message)) << text;
}

// What no surface needs is no reason to refuse a file.
TEST(Mgf, FaultsThatNothingNeedsArePassedOver) {
  EXPECT_EQ(mgf(kQuad + "m bad =\nrd 7\nv bad =\np x\nm grey\nf a b c d\n").triangles.size(), 2U);
  EXPECT_EQ(mgf(kQuad + "rd 7\nrd .5\nf a b c d\n").triangles.size(), 2U);
}

TEST(Mgf, SceneTomlPlacesItAndGivesMaterials) {
  const Texts texts{{"s.toml", "[[mesh]]\nfile = 'a.mgf'\ntranslate = [0, 0, 7]\n[material.tin]\nmirror = 0.5\n"},
                    {"a.mgf", kQuad + "m tin\nf a b c d\n"}};
  const Scene scene = load_texts(texts, "s.toml");
  EXPECT_EQ(scene.materials[0].kind, SurfaceKind::mirror);
  EXPECT_DOUBLE_EQ(bounds(scene).low[2], 7);
}

}  // namespace
}  // namespace torolux
