// SPDX-License-Identifier: MIT
// Proves what an OBJ may say and that all else is refused with file and line.
#include "emulator/errors.hpp"
#include "host_tools/scene/keep_on.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Refused {
  const char* name;
  std::string text;
  std::string place;
  std::string message;
};

class ObjRefusal : public testing::TestWithParam<Refused> {};

TEST_P(ObjRefusal, NamesFileAndLine) {
  const std::string message = refusal({{"a.obj", GetParam().text}}, "a.obj");
  EXPECT_THAT(message, StartsWith(GetParam().place + ": "));
  EXPECT_THAT(message, HasSubstr(GetParam().message));
}

/// A face of positions 1 and 2.
const std::string kTwice = "f 1 2 1\n";
const std::string kFour = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

INSTANTIATE_TEST_SUITE_P(
    Rules, ObjRefusal,
    testing::Values(Refused{"nan", "v 0 0 0\nv nan 0 0\n" + kTwice, "a.obj:2", "'nan' is not a finite number"},
                    Refused{"inf", "v 0 -inf 0\nv 0 0 1\n" + kTwice, "a.obj:1", "'-inf' is not a finite number"},
                    Refused{"overflow", "v 1e999 0 0\nv 0 0 1\n" + kTwice, "a.obj:1", "beyond what a number can hold"},
                    Refused{"large", "v 1e16 0 0\nv 0 0 1\n" + kTwice, "a.obj:1", "beyond 1e15"},
                    Refused{"garbage", "v 0 0 1x\nv 0 0 1\n" + kTwice, "a.obj:1", "'1x' is not a number"},
                    Refused{"hex", "v 0x10 0 0\nv 0 0 1\n" + kTwice, "a.obj:1", "'0x10' is not a number"},
                    Refused{"two_numbers", "v 0 0\nv 0 0 1\n" + kTwice, "a.obj:1", "v has 2 numbers"},
                    Refused{"zero", kFour + "f 1 0 2\n", "a.obj:5", "index 0"},
                    Refused{"beyond", kFour + "f 1 2 5\n", "a.obj:5", "there are 4 positions (v) in this file"},
                    Refused{"relative", kFour + "f -1 -2 -5\n", "a.obj:5", "index -5"},
                    Refused{"relative_not_yet", "f -1 -2 -3\n" + kFour, "a.obj:1", "there are 0 positions"},
                    Refused{"huge", kFour + "f 1 2 99999999999999999999\n", "a.obj:5", "is not an index"},
                    Refused{"normal_index", kFour + "f 1//x 2//1 3//1\n", "a.obj:5", "is not an index"},
                    Refused{"of_another_program", "banana 1\n", "a.obj", "no surface with an area"},
                    Refused{"index", kFour + "f 1 2 3.5\n", "a.obj:5", "is not an index"},
                    Refused{"empty_index", kFour + "f 1 2 /3\n", "a.obj:5", "is not an index"},
                    Refused{"zero_byte", std::string("v 0 0 0\n\0v", 10), "a.obj:2", "zero byte"},
                    Refused{"material", kFour + "usemtl red\nf 1 2 3\n", "a.obj:5", "material 'red' is not defined"},
                    Refused{"library", "mtllib no.mtl\nusemtl m\n" + kFour + "f 1 2 3\n", "a.obj:1",
                            "there is no material library 'no.mtl'"},
                    Refused{"continued", "# one\nv 0 \\\n 0 \\\n nan\nv 0 0 1\n" + kTwice, "a.obj:2", "'nan'"},
                    Refused{"carriage_return", "v 0 0 0\r\nv 0 0 q\r\n" + kTwice, "a.obj:2", "'q'"},
                    Refused{"no_area", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "a.obj", "no surface with an area"},
                    Refused{"one_point", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "a.obj", "no surface with an area"},
                    Refused{"empty", "", "a.obj", "no surface with an area"}),
    [](const auto& test) { return test.param.name; });

TEST(Obj, ReadsNumbersExactly) {
  const Scene scene = load_texts({{"a.obj", "v 0.3 +1.5e1 -.25\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"}}, "a.obj");
  EXPECT_EQ(scene.positions[0], (Vec3d{0.3, 15.0, -0.25}));
}

TEST(Obj, NegativeIndicesCountFromTheLastPosition) {
  const Scene scene = load_texts({{"a.obj", "v 9 9 9\n" + kFour + "f -4 -3 -2\nv 5 5 5\n"}}, "a.obj");
  ASSERT_EQ(scene.triangles.size(), 1U);
  EXPECT_EQ(scene.positions[scene.triangles[0].position[0]], (Vec3d{0, 0, 0}));
  EXPECT_EQ(scene.positions[scene.triangles[0].position[2]], (Vec3d{1, 1, 0}));
}

TEST(Obj, UseBeforeLibraryAndNamesWithSpacesAreResolved) {
  const Texts texts{{"a.obj", "usemtl deep red\n" + kTriangle + "mtllib my colours.mtl\n"},
                    {"my colours.mtl", "newmtl deep red\nKd 0.5 0.1 0.1\n"}};
  const Scene scene = load_texts(texts, "a.obj");
  EXPECT_EQ(scene.materials[0].name, "deep red");
  EXPECT_DOUBLE_EQ(scene.materials[0].diffuse[0], 0.5);
}

TEST(Obj, SeveralLibrariesInOneStatement) {
  const Texts texts{{"a.obj", "mtllib one.mtl two.mtl\nusemtl b\n" + kTriangle},
                    {"one.mtl", "newmtl a\nKd 1 0 0\n"},
                    {"two.mtl", "newmtl b\nKd 0 0.5 0\n"}};
  EXPECT_DOUBLE_EQ(load_texts(texts, "a.obj").materials[0].diffuse[1], 0.5);
}

TEST(Obj, NearestMaterialNameIsSuggested) {
  const Texts texts{{"a.obj", "mtllib a.mtl\nusemtl whte\n" + kTriangle}, {"a.mtl", "newmtl white\nKd 1 1 1\n"}};
  EXPECT_THAT(refusal(texts, "a.obj"), HasSubstr("did you mean 'white'?"));
}

TEST(Obj, EqualPositionsHaveOneIndexAndMinusZeroIsZero) {
  const Scene scene =
      load_texts({{"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 -0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 4 5 6\n"}}, "a.obj");
  EXPECT_EQ(scene.positions.size(), 4U);
  EXPECT_EQ(scene.triangles[0].position[0], scene.triangles[1].position[0]);
}

TEST(Obj, DuplicatesAndTrianglesWithoutAreaAreDroppedWithAWarning) {
  const Scene scene = load_texts({{"a.obj", kTriangle + "f 2 3 1\nf 1 1 2\nv 2 0 0\nf 1 2 5\n"}}, "a.obj");
  EXPECT_EQ(scene.triangles.size(), 1U);
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("a.obj:6: an exact duplicate")));
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("a.obj:7: a face without area")));
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("a.obj:9: a triangle without area")));
}

TEST(Obj, ManyDuplicatesMakeOneWarning) {
  const Scene scene = load_texts({{"a.obj", kTriangle + "f 1 2 3\nf 1 2 3\nf 1 2 3\n"}}, "a.obj");
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("(and 2 more)")));
}

TEST(Obj, NormalsAreKeptForMirrorGlassAndGlossyAlone) {
  const std::string faces = "vn 0 0 2\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl m\nf 1//1 2//1 3//1\n";
  const Texts mirror{{"a.obj", "mtllib a.mtl\n" + faces}, {"a.mtl", "newmtl m\nillum 3\nKs 0.9 0.9 0.9\n"}};
  const Scene smooth = load_texts(mirror, "a.obj");
  ASSERT_NE(smooth.triangles[0].normal[0], kNoNormal);
  EXPECT_EQ(smooth.normals[smooth.triangles[0].normal[0]], (Vec3d{0, 0, 1}));
  const Texts glossy{{"a.obj", "mtllib a.mtl\n" + faces}, {"a.mtl", "newmtl m\nillum 2\nKs 0.9 0.9 0.9\n"}};
  EXPECT_NE(load_texts(glossy, "a.obj").triangles[0].normal[0], kNoNormal);
  const Texts diffuse{{"a.obj", "mtllib a.mtl\n" + faces}, {"a.mtl", "newmtl m\nKd 0.9 0.9 0.9\n"}};
  EXPECT_EQ(load_texts(diffuse, "a.obj").triangles[0].normal[0], kNoNormal);
  EXPECT_TRUE(load_texts(diffuse, "a.obj").normals.empty());
}

TEST(Obj, NormalsThatPointToTheBackAreNotUsed) {
  const Texts texts{{"a.obj", "mtllib a.mtl\nvn 0 0 -1\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1//1 2//1 3//1\n"},
                    {"a.mtl", "newmtl m\nillum 7\nNi 1.5\n"}};
  const Scene scene = load_texts(texts, "a.obj");
  EXPECT_EQ(scene.triangles[0].normal[0], kNoNormal);
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("point to its back")));
}

TEST(Obj, MoreCornersThanAByteCounts) {
  // tinyobjloader keeps the number of a face's corners in a byte.
  std::string text;
  std::string face = "f";
  constexpr int corners = 300;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * 3.14159265358979 * i / corners;
    text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  EXPECT_EQ(load_texts({{"a.obj", text + face + "\n"}}, "a.obj").triangles.size(), std::size_t{corners - 2});
}

TEST(Obj, BareMeshGetsACameraInFrontThatSeesItWhole) {
  const Scene scene = load_texts({{"a.obj", kTriangle}}, "a.obj");
  ASSERT_TRUE(scene.camera.has_value());
  const Camera camera = scene.camera.value_or(Camera{});
  EXPECT_DOUBLE_EQ(camera.eye[0], 0.5);
  EXPECT_GT(camera.eye[2] * std::tan(camera.field_of_view_degrees * 3.14159265 / 360), 0.5);
  EXPECT_NO_THROW(check_camera(camera));
}

TEST(Obj, WithoutLightItIsRefusedByCheckRenderable) {
  const Scene scene = load_texts({{"a.obj", kTriangle}}, "a.obj");
  EXPECT_THROW(check_renderable(scene), InputError);
}

TEST(Obj, UnknownKindsOfFileAreRefusedWithWhatIsAllowed) {
  EXPECT_THAT(refusal({{"a.ply", "{}"}}, "a.ply"), HasSubstr("a folder with scene.toml, a .toml, an .obj"));
  EXPECT_THAT(refusal({}, "b.obj"), HasSubstr("there is no scene 'b.obj'"));
}

// What takes a minute ends where it stands.
TEST(Obj, ALargeMeshIsNotReadToItsEndAfterCtrlC) {
  std::string text;
  for (int i = 0; i < 10'000; ++i) text += "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n";
  set_interruption([] { return true; });
  EXPECT_THROW(load_texts({{"a.obj", text}}, "a.obj"), Interrupted);
  set_interruption([] { return false; });
  EXPECT_NO_THROW(load_texts({{"a.obj", text}}, "a.obj"));
  set_interruption(nullptr);
}

}  // namespace
}  // namespace torolux
