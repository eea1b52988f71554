// SPDX-License-Identifier: MIT
// Proves that MGF that would take longer than anybody waits, or more memory than there is, ends with a reason: file and
// line, what is allowed, what to do.
#include "host_tools/scene/mgf.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::HasSubstr;

const std::string kQuad = "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nv d =\np 0 1 0\nm grey =\nrd .5\n";
const std::string kLamp = "TILT=NONE\n1 1000 1 2 1 1 2 .1 .2 0\n1 1 1\n0 90\n0\n100 50\n";

std::string refused(const std::string& text) {
  return refusal({{"a.mgf", text}, {"b.ies", kLamp}}, "a.mgf");
}
/// What the import alone says, with other limits.
std::string beyond(const MgfLimits& limits, const Texts& texts) {
  MemoryFiles files(texts);
  Notices notices;
  try {
    import_mgf("a.mgf", files, {}, notices, limits);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(accepted)";
}
std::string times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(MgfLimits, Triangles) {
  EXPECT_EQ(refused(kQuad + "xf -a 1000000000 -t 0 0 1\nsph a 1\nxf\n"),
            "a.mgf:12: more than 4000000 triangles; make arrays (xf -a) smaller, or leave parts out");
  // Curved surfaces may turn out to have more than their least.
  EXPECT_EQ(beyond({100, 100}, {{"a.mgf", kQuad + "sph a 1\nxf -t 9 9 9\nsph a 1\nxf\n"}}),
            "a.mgf:11: more than 100 triangles; make arrays (xf -a) smaller, or leave parts out");
}

// Faces of many corners that make no triangles take memory, too.
TEST(MgfLimits, Corners) {
  const Texts flat{{"a.mgf", kQuad + "xf -a 10\nf a a a a a a\nxf\n"}};
  EXPECT_EQ(beyond({20, 100}, flat), "(accepted)");
  EXPECT_EQ(beyond({19, 100}, flat),
            "a.mgf:12: more than 57 corners of faces and curved surfaces; make arrays (xf -a) smaller, or leave parts "
            "out");
}

TEST(MgfLimits, Copies) {
  const std::string what_to_do = "repeat more than 5000000 statements; make them smaller";
  EXPECT_EQ(refused("xf -a 1000000000 -t 0 0 1e-9\nxf\n"),
            "a.mgf:2: arrays (-a) and files that are included again " + what_to_do);
  // Of files in which nothing stands.
  const Texts empty{{"a.mgf", kQuad + "i b.inc -a 1000\n"}, {"b.inc", "# nothing\n"}};
  EXPECT_EQ(beyond({100, 1000}, empty), "(accepted)");
  EXPECT_THAT(beyond({100, 999}, empty), HasSubstr("a.mgf:11: arrays (-a) and files that are included again repeat"));
  // Of files that include another twice, that one again, and so on.
  Texts twice{{"a.mgf", kQuad + "i 0.inc\n"}, {"24.inc", "f a b c\n"}};
  for (int i = 0; i < 24; ++i) twice[std::to_string(i) + ".inc"] = times(2, "i " + std::to_string(i + 1) + ".inc\n");
  EXPECT_THAT(beyond({10'000'000, 5'000'000}, twice),
              HasSubstr(".inc:2: arrays (-a) and files that are included again"));
  // Statements of very many words count as several.
  EXPECT_THAT(beyond({100, 50}, {{"a.mgf", "xf -a 10\nthing" + times(640, " a") + "\nxf\n"}}),
              HasSubstr("a.mgf:2: arrays (-a) and files that are included again repeat more than 50 statements"));
}

TEST(MgfLimits, Transforms) {
  EXPECT_EQ(
      refused(kQuad + "xf" + times(101, " -i 2 -rx 90") + "\nf a b c\nxf\n"),
      "a.mgf:11: more than 100 arrays and repetitions (-a, -i) in one transform; put some into a transform around "
      "it");
  EXPECT_EQ(refused(times(1001, "xf -t 1 0 0\n")),
            "a.mgf:1001: more than 1000 transforms one inside the other; close some (xf without arguments), or join "
            "them");
  const std::string far = "the transform moves or scales things beyond 1e-15 to 1e15; use other units";
  EXPECT_EQ(refused(kQuad + "xf -i 4000000000 -t 0 0 1e9\nf a b c d\nxf\n"), "a.mgf:11: " + far);
  EXPECT_EQ(refused(kQuad + "\nxf -i 4000 -s 2\nf a b c d\nxf\n"), "a.mgf:12: " + far);
  EXPECT_EQ(refused(kQuad + "xf -s 1e-16\nf a b c d\nxf\n"), "a.mgf:11: " + far);
  EXPECT_EQ(refused("xf -a 9999999999999999999999\n"),
            "a.mgf:1: '9999999999999999999999' is not a whole number; a count of copies is one from 1 on");
}

TEST(MgfLimits, FilesInFiles) {
  Texts nested{{"a.mgf", kQuad + "f a b c\ni 1.inc\n"}};
  for (int i = 1; i < 100; ++i) nested[std::to_string(i) + ".inc"] = "i " + std::to_string(i + 1) + ".inc\n";
  nested["100.inc"] = "\n";
  EXPECT_EQ(refusal(nested, "a.mgf"), "99.inc:1: more than 100 files that include one another; join some of them");
  nested["99.inc"] = "\n";
  EXPECT_EQ(refusal(nested, "a.mgf"), "(accepted)");
}

TEST(MgfLimits, Lamps) {
  EXPECT_EQ(refused(kQuad + "ies b.ies -a 20000 -rz .001\n"),
            "a.mgf:11: more than 10000 measured lamps that hang differently; make arrays (-a) smaller");
  // Those that hang alike are one, however many there are; but each has triangles, and is a copy.
  const Texts alike{{"a.mgf", kQuad + "ies b.ies -a 50 -t 1 0 0\n"}, {"b.ies", kLamp}};
  EXPECT_EQ(beyond({100, 50}, alike), "(accepted)");
  EXPECT_EQ(beyond({99, 50}, alike),
            "a.mgf:11: more than 99 triangles; make arrays (xf -a) smaller, or leave parts out");
  EXPECT_EQ(beyond({100, 49}, alike),
            "a.mgf:11: arrays (-a) and files that are included again repeat more than 49 statements; make them "
            "smaller");
  EXPECT_EQ(refused(kQuad + "ies b.ies -m 1e13\n"), "a.mgf:11: -m: a factor above 0 and at most 1e12 is allowed");
  EXPECT_EQ(refusal({{"a.mgf", "ies b.ies\n"}, {"b.ies", "TILT=NONE\n1 1 1 1001 1001 1 2 1 1 0\n"}}, "a.mgf"),
            "b.ies:2: more than 1000000 intensities; leave angles out");
  EXPECT_EQ(refusal({{"a.mgf", "ies b.ies\n"}, {"b.ies", "TILT=NONE\n1 1 1 3602\n"}}, "a.mgf"),
            "b.ies:2: the number of vertical angles is '3602'; 2 to 3601 are allowed");
}

// What differs in each copy is compared with all that came before; what is wrong alike in all is one.
TEST(MgfLimits, Materials) {
  const std::string drift =
      "c x =\ncxy .2 .3\nc y =\ncxy .3 .3\nxf -a 1000000\nc z =\ncmix 1000000 x 1 y\nc x = z\nm q =\nc x\nrd .4\n"
      "f a b c\nxf\n";
  EXPECT_EQ(refused(kQuad + drift),
            "a.mgf:19: more than 10000 materials of one name: a statement repeats with other values each time; make "
            "arrays (-a) smaller");
  EXPECT_THAT(refused(kQuad + "xf -a 100000 -t 0 0 .0001\nrd 7\nf a b c\nxf\n"),
              HasSubstr("a.mgf:12: 'rd' is 7; allowed are 0 to 1"));
}

TEST(MgfLimits, Colours) {
  EXPECT_EQ(refused("c x =\ncmix 1e16 x\n"), "a.mgf:2: a weight must be 0 to 1e15");
  EXPECT_EQ(refused("c x =\ncmix -1 x\n"), "a.mgf:2: a weight must be 0 to 1e15");
  EXPECT_EQ(refused("c x =\ncmix 0 x\n"), "a.mgf:2: this colour has no brightness; visible light has 380 to 780 nm");
  EXPECT_EQ(refused("cct 2e9\n"), "a.mgf:1: the temperature must be 100 to 1e9 kelvin");
  EXPECT_EQ(refused("cxy .5 .6\n"),
            "a.mgf:1: no light has this colour: its x and y are 0 and up, y not 0, and their sum is at most 1");
  EXPECT_EQ(refused("cspec 1 2e6 1 1\n"),
            "a.mgf:1: the spectrum runs from 1 to 2e6 nm; it must run upwards, within 1e6 nm");
}

TEST(MgfLimits, Sizes) {
  EXPECT_EQ(refused(kQuad + "sph a 1e16\n"), "a.mgf:11: a radius beyond 1e15; use other units");
  EXPECT_EQ(refused("v a =\np 1e16 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nf a b c\n"),
            "a.mgf:2: a coordinate beyond 1e15 in magnitude; use other units");
}

}  // namespace
}  // namespace torolux
