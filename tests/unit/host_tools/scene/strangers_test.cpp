// SPDX-License-Identifier: MIT
// Proves that files as other programs write them are read as what they mean: the scene is the one of a plain file, and
// what was passed over or read otherwise is told, once, with file and line; and that only what bears on the picture is
// refused. Each case is named for the program that is known to write it, where one is.
#include "tests/unit/host_tools/scene/plain_room.hpp"

namespace torolux {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

struct Stranger {
  const char* name;
  std::string obj;
  std::string mtl;
  std::vector<std::string> told;  ///< the beginnings of all notes but that on the camera
};

class ReadAsPlain : public testing::TestWithParam<Stranger> {};

TEST_P(ReadAsPlain, AndTold) {
  const Scene plain = load({{"room.obj", kObj}, {"room.mtl", kLibrary}});
  const Texts texts{{"room.obj", GetParam().obj}, {"room.mtl", GetParam().mtl}};
  const Scene scene = load(texts);
  expect_same(scene, plain);
  expect_told(scene, GetParam().told);
  MemoryFiles files(texts);
  SceneOptions strict;
  strict.strict = true;
  strict.camera = Camera{};
  if (GetParam().told.empty()) {
    EXPECT_NO_THROW(load_scene_from(files, "room.obj", strict));
  } else {
    EXPECT_THROW(load_scene_from(files, "room.obj", strict), InputError);
  }
}

std::string utf16(const std::string& ascii, bool high_first) {
  std::string text = high_first ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : ascii) {
    if (high_first) text.push_back('\0');
    text.push_back(c);
    if (!high_first) text.push_back('\0');
  }
  return text;
}

const std::string kMark = "\xEF\xBB\xBF";
const std::string kZero(1, '\0');

INSTANTIATE_TEST_SUITE_P(
    Text, ReadAsPlain,
    testing::Values(Stranger{"plain", kObj, kLibrary, {}},
                    Stranger{"carriage_returns", replaced(kObj, "\n", "\r\n"), kLibrary, {}},
                    Stranger{"old_mac", replaced(kObj, "\n", "\r"), replaced(kLibrary, "\n", "\r"), {}},
                    Stranger{"mark_utf8", kMark + kObj, kMark + kLibrary, {"room.obj:1: a byte order mark"}},
                    Stranger{"utf16_little", utf16(kObj, false), kLibrary, {"room.obj:1: UTF-16"}},
                    Stranger{"utf16_big", kObj, utf16(kLibrary, true), {"room.mtl:1: UTF-16"}},
                    Stranger{"joined_files",
                             kMark + "mtllib room.mtl\n" + kMark + kPoints + kFaces,
                             kLibrary,
                             {"room.obj:1: a byte order mark"}},
                    Stranger{"zbrush_zero", kObj + kZero, kLibrary, {"room.obj: zero bytes at the end"}},
                    Stranger{"zeroes_and_blanks",
                             kObj + "\n \n" + kZero + "\n" + kZero,
                             kLibrary + kZero + kZero,
                             {"room.obj: zero bytes at the end"}},
                    Stranger{"no_end_of_line_then_zero",
                             kObj.substr(0, kObj.size() - 1) + kZero,
                             kLibrary,
                             {"room.obj: zero bytes at the end"}},
                    Stranger{"dos_end_of_file", kObj + "\x1A", kLibrary, {"room.obj: zero bytes at the end"}},
                    Stranger{"zbrush_colours", "#MRGB 00ffffff00ffffff\n" + kObj, kLibrary, {}},
                    Stranger{"comment_after_numbers",
                             replaced(kObj, "f 5 6 7", "f 5 6 7 # the lamp"),
                             replaced(kLibrary, "0.75", "0.75 # warm"),
                             {}},
                    Stranger{"continued", replaced(kObj, "f 1 2 3 4", "f 1 2 \\\n 3 4"), kLibrary, {}}),
    [](const auto& test) { return std::string(test.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Obj, ReadAsPlain,
    testing::Values(
        Stranger{"skin_weights",
                 kObj + "vw 1 0 0.5\nvw 2 0 0.5\nvw 3 0 1\n",
                 kLibrary,
                 {"room.obj:13: statement 'vw' is not of the format and passed over (and 2 more)"}},
        Stranger{"mistyped",
                 "mtllib room.mtl\nusemlt lamp\n" + kPoints + kFaces,
                 kLibrary,
                 {"room.obj:2: statement 'usemlt' is not of the format and passed over; did you mean 'usemtl'?"}},
        Stranger{"capitals",
                 replaced(replaced(kObj, "usemtl", "UseMtl"), "v ", "V "),
                 kLibrary,
                 {"room.obj:2: a statement in another letter case is read: 'V' as v (and 8 more)"}},
        Stranger{"loose_edge",
                 kObj + "f 1 2\nf 1\nf\n",
                 kLibrary,
                 {"room.obj:13: a face with fewer than three corners is left out: 'f 1 2' (and 2 more)"}},
        Stranger{"two_different_corners",
                 kObj + "f 1 2 1\nf 1 1 1\n",
                 kLibrary,
                 {"room.obj:13: a face without area is left out (and 1 more)"}},
        Stranger{"colours_of_vertices",
                 replaced(kObj, "v 0 0 0", "v 0 0 0 0.5 1 0.25"),
                 kLibrary,
                 {"room.obj:2: colours of vertices are not used"}},
        Stranger{"colours_with_alpha",
                 replaced(kObj, "v 0 0 0", "v 0 0 0 255 0 0 255"),
                 kLibrary,
                 {"room.obj:2: colours of vertices are not used"}},
        Stranger{"colours_not_finite",
                 replaced(kObj, "v 0 0 0", "v 0 0 0 nan -nan(ind) inf"),
                 kLibrary,
                 {"room.obj:2: colours of vertices are not used"}},
        Stranger{"weight_of_one", replaced(kObj, "v 0 0 0", "v 0 0 0 1.0"), kLibrary, {}},
        Stranger{"weight",
                 replaced(kObj, "v 0 0 0", "v 0 0 0 0.5"),
                 kLibrary,
                 {"room.obj:2: weights of vertices are not used: '0.5'"}},
        Stranger{"cinema4d_normal_zero",
                 replaced(kObj, "f 1 2 3 4", "vt 0 0\nf 1/1/0 2/1/0 3/1/0 4/1/0"),
                 kLibrary,
                 {"room.obj:11: index 0 of a normal or texture point: the corner has none: '1/1/0' (and 3 more)"}},
        Stranger{"texture_point_zero",
                 replaced(kObj, "f 1 2 3 4", "f 1/0 2/0 3/0 4/0"),
                 kLibrary,
                 {"room.obj:10: index 0 of a normal or texture point"}},
        Stranger{"normals_missing",
                 replaced(kObj, "f 1 2 3 4", "f 1//1 2//1 3//7 4//-3"),
                 kLibrary,
                 {"room.obj:10: a face's normals (vn) are not there or not finite; nothing needs them (and 1 more)"}},
        Stranger{"texture_points_missing",
                 replaced(kObj, "f 1 2 3 4", "f 1/1 2/2 3/3 4/4"),
                 kLibrary,
                 {"room.obj:10: a face's texture points (vt) are not there"}},
        Stranger{"normals_not_finite",
                 replaced(kObj, "f 1 2 3 4", "vn -1.#IND nan 0\nf 1//1 2//1 3//1 4//1"),
                 kLibrary,
                 {"room.obj:10: a normal (vn) is not three finite numbers: '-1.#IND' is not a number",
                  "room.obj:11: a face's normals (vn) are not there or not finite"}},
        Stranger{"normal_too_short", kObj + "vn 0 1\n", kLibrary, {"room.obj:13: a normal (vn) is not three"}},
        Stranger{
            "texture_point_not_finite",
            kObj + "vt nan 0\nvt\nvt 0 0 nan\n",
            kLibrary,
            {"room.obj:13: a texture point (vt) is not finite numbers: 'nan' is not a finite number (and 1 more)"}},
        Stranger{"unused_position", kObj + "v nan 0 0\nv 1e30 0 0\n", kLibrary, {}},
        Stranger{"tiny_number", replaced(kObj, "v 0 0 0", "v 0 1e-400 -1e-400"), kLibrary, {}},
        Stranger{"positions_behind_faces", "mtllib room.mtl\n" + kFaces + kPoints, kLibrary, {}},
        Stranger{"library_without_name", "mtllib\n" + kObj, kLibrary, {"room.obj:1: mtllib without a file name"}}),
    [](const auto& test) { return std::string(test.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Mtl, ReadAsPlain,
    testing::Values(
        Stranger{"hash_in_names",
                 replaced(replaced(kObj, "usemtl wall", "usemtl Material #1"), "lamp", "Material #2"),
                 replaced(replaced(kLibrary, "wall", "Material #1"), "lamp", "Material #2"),
                 {}},
        Stranger{"hash_in_groups", "o box #1\ng part # 2\n" + kObj, kLibrary, {}},
        Stranger{"comment_after_name",
                 kObj,
                 replaced(kLibrary, "newmtl wall", "newmtl wall # plaster"),
                 {"room.obj:9: a material is found under another name: 'wall' is 'wall # plaster'"}},
        Stranger{"quoted_name",
                 replaced(kObj, "usemtl wall", "usemtl \"wall\""),
                 kLibrary,
                 {"room.obj:9: a material is found under another name: '\"wall\"' is 'wall'"}},
        Stranger{"name_in_another_case",
                 replaced(kObj, "usemtl wall", "usemtl Wall"),
                 kLibrary,
                 {"room.obj:9: a material is found under another name: 'Wall' is 'wall'"}},
        Stranger{"same_twice",
                 kObj,
                 kLibrary + kLibrary,
                 {"room.mtl:6: a material is given again, the same: 'wall', first at room.mtl:1 (and 1 more)"}},
        Stranger{"different_twice",
                 kObj,
                 "newmtl wall\nKd 0 0 1\n" + kLibrary,
                 {"room.mtl:3: a material is given again, another one: this last one counts: 'wall', first at "
                  "room.mtl:1"}},
        Stranger{"other_cases",
                 kObj,
                 replaced(replaced(kLibrary, "Kd", "kd"), "newmtl", "NEWMTL"),
                 {"room.mtl:1: a statement in another letter case is read: 'NEWMTL' as newmtl (and 3 more)"}},
        Stranger{"old_blender_ni",
                 kObj,
                 replaced(kLibrary, "Kd 0.5", "Ni -1.000000\nillum 1\nKd 0.5"),
                 {"room.mtl:2: a value is not right, but the material does not need it: Ni is -1.000000"}},
        Stranger{"values_not_used",
                 kObj,
                 replaced(kLibrary, "Kd 0.5", "Ks -1 nan x\nNs 1 2\nTf spectral f.rfl\nNi\nKd 0.5"),
                 {"room.mtl:1: Ks is used for glossy surfaces",
                  "room.mtl:2: a value is not right, but the material does not need it: Ks is -1; it must not be "
                  "negative (and 3 more)"}},
        Stranger{"alpha",
                 kObj,
                 replaced(kLibrary, "0.75", "0.75 1.0"),
                 {"room.mtl:2: a fourth number (alpha) of a colour is not used: Kd 1.0"}},
        Stranger{
            "last_value_counts",
            kObj,
            replaced(kLibrary, "Kd 0.5", "Kd nan\nKd 0.5"),
            {"room.mtl:3: of a statement that stands twice in a material the last one counts: Kd, first in line 2"}},
        Stranger{"values_of_a_material_without_faces",
                 kObj,
                 kLibrary + "newmtl unused\nKd nan 0 0\nillum 40\n",
                 {"room.mtl:7: a value is not right, but the material does not need it: 'nan' is not a finite number "
                  "(and 1 more)"}},
        Stranger{"before_the_first",
                 kObj,
                 "Ka 1 1 1\nillum 2\n" + kLibrary,
                 {"room.mtl:1: statements before the first newmtl are passed over: 'Ka' (and 1 more)"}},
        Stranger{"empty_texture",
                 kObj,
                 replaced(kLibrary, "0.75", "0.75\nmap_Kd"),
                 {"room.mtl:3: map_Kd without a file name: no texture"}},
        Stranger{"only_options",
                 kObj,
                 replaced(kLibrary, "0.75", "0.75\nmap_Kd -s 1 1 1 -o"),
                 {"room.mtl:3: option -o of map_Kd without a value is not used",
                  "room.mtl:3: map_Kd without a file name: no texture"}},
        Stranger{"dissolve_unreadable",
                 kObj,
                 replaced(kLibrary, "0.75", "0.75\nd x\nTr"),
                 {"room.mtl:3: transparency by d or Tr that is not a number from 0 to 1"}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Strangers, ManyNotesOfOneKindAreOne) {
  std::string obj = kObj;
  for (int i = 0; i < 1000; ++i) obj += "vw 1 0 0.5\n";
  EXPECT_THAT(notes(load({{"room.obj", obj}, {"room.mtl", kLibrary}})), ElementsAre(HasSubstr("(and 999 more)")));
  for (int i = 0; i < 1000; ++i) obj += "x" + std::to_string(i) + "\n";
  EXPECT_EQ(notes(load({{"room.obj", obj}, {"room.mtl", kLibrary}})).size(), 101U) << "kinds are not without end";
}

TEST(Strangers, UseOfNoNameIsWhiteOrTheMaterialWithoutOne) {
  const Texts blender{{"room.obj", replaced(kObj, "usemtl wall", "usemtl ")}, {"room.mtl", kLibrary}};
  const Scene white = load(blender);
  EXPECT_EQ(white.materials[0].diffuse, (Vec3d{0.99, 0.99, 0.99}));
  expect_told(white, {"room.obj:9: usemtl without a name: white"});
  Texts named = blender;
  named["room.mtl"] = replaced(kLibrary, "newmtl wall", "newmtl");
  expect_same(load(named), load({{"room.obj", kObj}, {"room.mtl", kLibrary}}));
  Texts overridden = blender;
  overridden["room.toml"] = "[[mesh]]\nfile = 'room.obj'\n[material.'(no name)']\ndiffuse = 0.25\n";
  EXPECT_EQ(load(overridden).materials[0].diffuse, (Vec3d{0.25, 0.25, 0.25}));
}

TEST(Strangers, WhatIsNeededIsRefused) {
  const auto room = [](const std::string& obj, const std::string& mtl) {
    return refusal({{"room.obj", obj}, {"room.mtl", mtl}}, "room.obj");
  };
  const std::string glass = replaced(kLibrary, "Kd 0.5 0.25 0.75", "illum 7\nNi 1.5");
  EXPECT_THAT(room(replaced(kObj, "f 1 2 3 4", "f 1//1 2//1 3//1 4//1"), glass),
              AllOf(StartsWith("room.obj:10: a corner's normal (vn) is not there"), HasSubstr("'wall'")));
  EXPECT_THAT(room(replaced(kObj, "f 1 2 3 4", "vn nan 0 0\nf 1//1 2//1 3//1 4//1"), glass),
              StartsWith("room.obj:11: "));
  EXPECT_THAT(room(kObj, replaced(glass, "Ni 1.5", "Ni nan")), StartsWith("room.mtl:3: 'nan' is not a finite number"));
  EXPECT_THAT(room(kObj, replaced(kLibrary, "Kd 0.5", "Ks 0.5 0.5 0.5\nNs -1\nillum 2\nKd 0.5")),
              StartsWith("room.mtl:3: Ns is -1"));
  EXPECT_THAT(room(kObj, replaced(kLibrary, "Kd 0.5", "illum 3\nKs nan 0 0\nKd 0.5")), StartsWith("room.mtl:3: 'nan'"));
  EXPECT_THAT(room(kObj, replaced(kLibrary, "Ke 8", "Ke -8")), StartsWith("room.mtl:5: Ke is -8"));
  EXPECT_THAT(room(replaced(kObj, "v 0 0 0", "v 0 0"), kLibrary), StartsWith("room.obj:2: v has 2 numbers"));
  EXPECT_THAT(room(replaced(kObj, "v 0 0 0", "v 0 0 0" + kZero), kLibrary), StartsWith("room.obj:2: a zero byte"));
  EXPECT_THAT(room(utf16(kObj, true).substr(0, 51), kLibrary), HasSubstr("is not UTF-16"));
}

TEST(Strangers, OverridesTakeTheFaultsOfWhatTheyReplace) {
  const Texts texts{{"room.obj", kObj},
                    {"room.mtl", replaced(kLibrary, "Kd 0.5", "illum 99\nKd nan")},
                    {"room.toml", "[[mesh]]\nfile = 'room.obj'\n[material.wall]\ndiffuse = [0.5, 0.25, 0.75]\n"}};
  expect_same(load(texts), load({{"room.obj", kObj}, {"room.mtl", kLibrary}}));
  Texts emitting = texts;
  emitting["room.toml"] = "[[mesh]]\nfile = 'room.obj'\n[material.wall]\nemission = 3\n";
  EXPECT_THAT(refusal(emitting, "room.toml"), StartsWith("room.mtl:"));
}

}  // namespace
}  // namespace torolux
