// SPDX-License-Identifier: MIT
// Proves that the material libraries of a mesh are found under the names that other programs write for them, which is
// told; that names which might mean several files are refused, and a library that is nowhere where it is missed.
#include "tests/unit/host_tools/scene/plain_room.hpp"

namespace torolux {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

struct Found {
  const char* name;
  std::string written;
  std::string file;
  std::string told;  ///< "": nothing
};

class FoundLibrary : public testing::TestWithParam<Found> {};

TEST_P(FoundLibrary, UnderWhatIsWritten) {
  const Scene plain = load({{"room.obj", kObj}, {"room.mtl", kLibrary}});
  const Scene scene =
      load({{"room.obj", "mtllib " + GetParam().written + "\n" + kPoints + kFaces}, {GetParam().file, kLibrary}});
  expect_same(scene, plain);
  if (GetParam().told.empty()) {
    EXPECT_THAT(notes(scene), IsEmpty());
  } else {
    EXPECT_THAT(notes(scene), ElementsAre(AllOf(StartsWith("room.obj:1: "), HasSubstr(GetParam().told))));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Names, FoundLibrary,
    testing::Values(Found{"backslashes", "lib\\room.mtl", "lib/room.mtl", ""},
                    Found{"with_blanks", "my room.mtl", "my room.mtl", ""},
                    Found{"with_hash", "room #2.mtl", "room #2.mtl", ""}, Found{"dot", "./room.mtl", "room.mtl", ""},
                    Found{"quoted", "\"my room.mtl\"", "my room.mtl", "is 'my room.mtl'"},
                    Found{"quoted_single", "'room.mtl'", "room.mtl", "is 'room.mtl'"},
                    Found{"comment", "room.mtl # of the room", "room.mtl", "is 'room.mtl'"},
                    Found{"case", "ROOM.MTL", "room.mtl", "'ROOM.MTL' is 'room.mtl'"},
                    Found{"case_of_folders", "Lib/Room.mtl", "LIB/room.mtl", "is 'LIB/room.mtl'"},
                    Found{"windows_path", "C:\\Users\\me\\my scene\\room.mtl", "room.mtl", "is 'room.mtl'"},
                    Found{"unix_path", "/home/me/scene/room.mtl", "room.mtl", "is 'room.mtl'"},
                    Found{"path_and_case", "D:/scene/Room.MTL", "room.mtl", "is 'room.mtl'"},
                    Found{"drive_alone", "C:room.mtl", "room.mtl", "is 'room.mtl'"},
                    Found{"quoted_path", "\"C:\\a b\\room.mtl\"", "room.mtl", "is 'room.mtl'"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(LibraryNames, SeveralLibrariesInQuotationMarks) {
  const Texts texts{{"room.obj", "mtllib \"a b.mtl\" c.mtl\n" + kPoints + kFaces},
                    {"a b.mtl", "newmtl wall\nKd 0.5 0.25 0.75\n"},
                    {"c.mtl", "newmtl lamp\nKd 0 0 0\nKe 8 8 8\n"}};
  expect_same(load(texts), load({{"room.obj", kObj}, {"room.mtl", kLibrary}}));
}

TEST(LibraryNames, FilesThatDifferByCaseAloneAreNotGuessed) {
  const Texts texts{
      {"room.obj", replaced(kObj, "room.mtl", "Room.mtl")}, {"room.mtl", kLibrary}, {"ROOM.mtl", kLibrary}};
  EXPECT_THAT(refusal(texts, "room.obj"), AllOf(StartsWith("room.obj:1: "), HasSubstr("'ROOM.mtl' and 'room.mtl'")));
}

TEST(LibraryNames, ALibraryThatIsNowhereIsRefusedWhereItIsMissed) {
  const Texts nowhere{{"room.obj", kObj}};
  EXPECT_THAT(refusal(nowhere, "room.obj"),
              AllOf(StartsWith("room.obj:1: there is no material library 'room.mtl', and material 'wall'"),
                    HasSubstr("--missing-materials white")));
  Texts given = nowhere;
  given["room.toml"] =
      "[[mesh]]\nfile = 'room.obj'\n[material.wall]\ndiffuse = [0.5, 0.25, 0.75]\n[material.lamp]\nemission = 8\n";
  const Scene scene = load(given);
  expect_same(scene, load({{"room.obj", kObj}, {"room.mtl", kLibrary}}));
  expect_told(scene, {"room.obj:1: there is no material library 'room.mtl'"});
  MemoryFiles files(nowhere);
  SceneOptions white;
  white.missing_materials = MissingMaterials::white;
  const Scene plain = load_scene_from(files, "room.obj", white);
  EXPECT_EQ(plain.materials[1].diffuse, (Vec3d{0.99, 0.99, 0.99}));
  expect_told(plain,
              {"room.obj:1: there is no material library",
               "room.obj:9: a material that is not defined is white, diffuse with reflectance 0.99: 'wall' (and 1 "
               "more)"});
}

}  // namespace
}  // namespace torolux
