// SPDX-License-Identifier: MIT
// Proves how measured lamps (IESNA LM-63) are read: angles and their symmetries, factors, units, sizes, flux; how MGF
// and scene.toml hang them; and that mistakes say where they are.
#include "host_tools/scene/ies.hpp"

#include <cmath>
#include <numbers>

#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/lamp_web.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const std::string kHead = "IESNA:LM-63-2002\n[TEST] none\nTILT=NONE\n";

MeasuredLamp lamp(const std::string& text, Notices& notices) {
  return read_ies(text, "a.ies", notices);
}
MeasuredLamp lamp(const std::string& text) {
  Notices notices;
  return lamp(text, notices);
}
std::string refused(const std::string& text) {
  try {
    lamp(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(accepted)";
}
double candela(const MeasuredLamp& of, double gamma, double turn) {
  return intensity_of(of.web, gamma, turn) * kLumenPerWatt;
}

TEST(Ies, SameAllAroundAndItsFlux) {
  const MeasuredLamp of = lamp(kHead + "1 1000 1 3 1 1 2 0.5 0.25 0\n1 1 10\n0 90 180\n0\n100 100 100\n");
  EXPECT_NEAR(candela(of, 37, 200), 100, 1e-9);
  EXPECT_NEAR((of.flux[0] + of.flux[1]) * kLumenPerWatt, 400 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(of.flux[0], of.flux[1], 1e-12);
  EXPECT_EQ(of.width, 0.5);
  EXPECT_EQ(of.length, 0.25);
  EXPECT_FALSE(of.round);
}

// I = 100 (1 - gamma / 90): its integral is 2 pi 100 (1 - 2 / pi).
TEST(Ies, FluxIsTheIntegralOfWhatIsInterpolated) {
  const MeasuredLamp of = lamp(kHead + "1 1000 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n100 0\n");
  EXPECT_NEAR(of.flux[0] * kLumenPerWatt, 200 * std::numbers::pi * (1 - 2 / std::numbers::pi), 1e-9);
  EXPECT_EQ(of.flux[1], 0);
  EXPECT_EQ(candela(of, 91, 0), 0);
}

TEST(Ies, Symmetries) {
  const std::string gammas = "0 90\n";
  const MeasuredLamp quarter = lamp(kHead + "1 1 1 2 3 1 2 0 0 0\n1 1 1\n" + gammas + "0 30 90\n9 1\n9 2\n9 3\n");
  const MeasuredLamp half = lamp(kHead + "1 1 1 2 3 1 2 0 0 0\n1 1 1\n" + gammas + "0 30 180\n9 1\n9 2\n9 3\n");
  const MeasuredLamp whole = lamp(kHead + "1 1 1 2 3 1 2 0 0 0\n1 1 1\n" + gammas + "0 30 360\n9 1\n9 2\n9 1\n");
  const MeasuredLamp across =
      lamp(kHead + "1 1 1 2 4 1 2 0 0 0\n1 1 1\n" + gammas + "90 120 180 270\n9 1\n9 2\n9 3\n9 4\n");
  for (const MeasuredLamp* of : {&quarter, &half, &whole, &across}) {
    EXPECT_EQ(of->web.turn.front(), 0);
    EXPECT_EQ(of->web.turn.back(), 360);
    EXPECT_TRUE(std::ranges::is_sorted(of->web.turn));
    EXPECT_EQ(of->web.intensity.size(), of->web.turn.size() * 2);
    EXPECT_NEAR(candela(*of, 90, 0), candela(*of, 90, 360), 1e-9);
  }
  for (const double turn : {30.0, 150.0, 210.0, 330.0}) EXPECT_NEAR(candela(quarter, 90, turn), 2, 1e-9);
  EXPECT_NEAR(candela(half, 90, 330), 2, 1e-9);
  EXPECT_NEAR(candela(half, 90, 180), 3, 1e-9);
  EXPECT_NEAR(candela(whole, 90, 195), 1.5, 1e-9);
  EXPECT_NEAR(candela(across, 90, 60), 2, 1e-9) << "as at 120";
  EXPECT_NEAR(candela(across, 90, 0), 3, 1e-9);
  EXPECT_NEAR(candela(across, 90, 270), 4, 1e-9);
}

TEST(Ies, FactorsAndTilt) {
  const std::string numbers = "1 -1 2 2 1 1 2 0 0 0\n0.5 3 10\n0 90\n0\n100, 100\n";
  EXPECT_NEAR(candela(lamp("an old file\nTilt = none\n" + numbers), 45, 0), 300, 1e-9);
  EXPECT_NEAR(candela(lamp(kHead + numbers), 45, 0), 100, 1e-9) << "for future use since 1995";
  Notices notices;
  const MeasuredLamp tilted =
      lamp("IESNA:LM-63-2002\r\nTILT=INCLUDE\r\n1\r\n3\r\n-90 0 90\r\n0.5 0.9 0.5\r\n" + numbers, notices);
  EXPECT_NEAR(candela(tilted, 45, 0), 90, 1e-9);
  EXPECT_THAT(notices.lines(), Contains(HasSubstr("TILT=INCLUDE")));
  Notices elsewhere;
  lamp("TILT=other.tlt\n" + numbers, elsewhere);
  EXPECT_THAT(elsewhere.lines(), Contains("a.ies:1: factors for tilted lamps in another file are not read: the lamp "
                                          "hangs as it was measured: 'other.tlt'"));
}

TEST(Ies, Sizes) {
  const auto with = [](const std::string& units_and_size) {
    return lamp(kHead + "1 1 1 2 1 1 " + units_and_size + "\n1 1 1\n0 90\n0\n1 1\n");
  };
  EXPECT_NEAR(with("1 2 4 0").length, 4 * 0.3048, 1e-12) << "feet";
  EXPECT_NEAR(with("1 2 4 0").width, 2 * 0.3048, 1e-12);
  EXPECT_TRUE(with("2 -0.3 -0.3 0").round);
  EXPECT_NEAR(with("2 -0.3 -0.3 0").length, 0.3, 1e-12);
  EXPECT_NEAR(with("2 -0.3 0 0").width, 0.3, 1e-12);
  EXPECT_TRUE(with("2 0 0 0").round);
  EXPECT_EQ(with("2 0 0 0").length, 0.02);
  EXPECT_EQ(with("2 0 1.2 0").width, 0.02);
  EXPECT_FALSE(with("2 0 1.2 0").round);
}

TEST(Ies, MistakesSayWhere) {
  EXPECT_EQ(refused("nothing\n"), "a.ies: no line begins with TILT=: this is not a measured lamp (IESNA LM-63)");
  EXPECT_THAT(refused(kHead + "1 1 1 2 1 2 2 0 0 0\n"), StartsWith("a.ies:4: photometry of type B"));
  EXPECT_THAT(refused(kHead + "1 1 1 2 1 3 2 0 0 0\n"), StartsWith("a.ies:4: photometry of type A"));
  EXPECT_THAT(refused(kHead + "1 x"), StartsWith("a.ies:4: the lumens of each lamp"));
  EXPECT_THAT(refused(kHead + "1 1 1 1.5"), StartsWith("a.ies:4: the number of vertical angles"));
  const std::string head = kHead + "1 1 1 3 2 1 2 0 0 0\n1 1 1\n";
  EXPECT_THAT(refused(head + "0 90 90\n"), StartsWith("a.ies:6: vertical angles must rise"));
  EXPECT_THAT(refused(head + "0 90 200\n0 90\n"), StartsWith("a.ies:6: a vertical angle above 180"));
  EXPECT_THAT(refused(head + "0 45 90\n0 60\n1 1 1\n1 1 1\n"), StartsWith("a.ies:7: horizontal angles from 0 to 60"));
  EXPECT_THAT(refused(head + "0 45 90\n0 90\n1 1 1\n1 1\n"), StartsWith("a.ies:9: the file ends where an intensity"));
  EXPECT_THAT(refused(head + "0 45 90\n0 90\n0 0 0\n0 0 -1\n"), HasSubstr("the lamp gives no light"));
}

TEST(Ies, DecimalCommasAreRefusedAndOthersPartNumbers) {
  const std::string told =
      "commas part numbers here (IESNA LM-63), and so read they are not a lamp. Write decimal points";
  EXPECT_EQ(refused(kHead + "1 1000 1 3 1 1 2 0,5 0,25 0\n1 1 10\n0 90 180\n0\n100 100 100\n"),
            "a.ies:4: a number with a decimal comma, '0,5': " + told);
  // As many numbers as there should be, and more.
  EXPECT_EQ(refused(kHead + "1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 90 180\n0\n100,5 90,25 80\n"),
            "a.ies:8: a number with a decimal comma, '100,5': " + told);
  EXPECT_NEAR(candela(lamp(kHead + "1,1000,1,3,1,1,2,0,0,0\n1,1,10\n0,90,180\n0\n100,90,80\n"), 90, 0), 90, 1e-9);
  EXPECT_NEAR(candela(lamp(kHead + "1 1000 1 2 1 1 2 0 0 0\n1 1 10\n0,90\n0\n100,90\n"), 90, 0), 90, 1e-9);
}

const std::string kIes = kHead + "1 1000 1 3 2 1 2 0.5 1 0\n1 1 10\n0 90 180\n0 90\n100 50 10\n100 60 10\n";

double lumens(const Scene& scene) {
  double sum = 0;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const SceneMaterial& material = scene.materials[scene.triangles[t].material];
    sum += kLumenPerWatt * std::numbers::pi * area(scene, t) * luminance(material.emission);
  }
  return sum;
}
double measured_lumens() {
  const MeasuredLamp of = lamp(kIes);
  return (of.flux[0] + of.flux[1]) * kLumenPerWatt;
}

TEST(Ies, HangsInMgf) {
  const Texts texts{{"a.mgf", "ies b.ies -m 0.5 -rz 90 -t 0 0 3 -a 2 -t 5 0 0\nies b.ies -s 2 -mx\n"}, {"b.ies", kIes}};
  const Scene scene = load_texts(texts, "a.mgf");
  EXPECT_NEAR(lumens(scene), measured_lumens() * (0.5 + 0.5 + 4), 1e-6);
  EXPECT_EQ(scene.webs.size(), 1U);
  ASSERT_EQ(scene.lamps.size(), 2U) << "those that hang alike are one";
  const SceneLamp& turned = scene.lamps[0];
  EXPECT_NEAR(vec::dot(turned.x, {0, 1, 0}), 1, 1e-12);
  EXPECT_NEAR(vec::dot(turned.y, {-1, 0, 0}), 1, 1e-12);
  EXPECT_NEAR(vec::dot(turned.nadir, {0, 0, -1}), 1, 1e-12);
  EXPECT_NEAR(vec::dot(scene.lamps[1].x, {-1, 0, 0}), 1, 1e-12) << "mirrored";
  EXPECT_NEAR(vec::dot(scene.lamps[1].y, {0, 1, 0}), 1, 1e-12);
  for (const SceneTriangle& t : scene.triangles) {
    const Vec3d& a = scene.positions[t.position[0]];
    const Vec3d across =
        vec::cross(vec::subtract(scene.positions[t.position[1]], a), vec::subtract(scene.positions[t.position[2]], a));
    EXPECT_LT(across[2], 0) << "fronts look down";
  }
}

TEST(Ies, TurnsWithItsMesh) {
  const Texts texts{{"s.toml", "[[mesh]]\nfile = 'a.mgf'\nrotate = [-90, 0, 0]\nflip = true\n"},
                    {"a.mgf", "ies b.ies\n"},
                    {"b.ies", kIes}};
  const Scene scene = load_texts(texts, "s.toml");
  EXPECT_NEAR(vec::dot(scene.lamps[0].nadir, {0, -1, 0}), 1, 1e-12);
  EXPECT_NEAR(vec::dot(scene.lamps[0].x, {1, 0, 0}), 1, 1e-12);
  EXPECT_NEAR(vec::dot(scene.lamps[0].y, {0, 0, -1}), 1, 1e-12);
  const auto& p = scene.triangles[0].position;
  const Vec3d& a = scene.positions[p[0]];
  EXPECT_LT(vec::cross(vec::subtract(scene.positions[p[1]], a), vec::subtract(scene.positions[p[2]], a))[1], 0);
}

TEST(Ies, HangsInSceneToml) {
  const auto scene_of = [](const std::string& keys) {
    return load_texts({{"s.toml", "[room]\nsize = [4, 3, 5]\n[[lamp]]\nies = 'b.ies'\n" + keys}, {"b.ies", kIes}},
                      "s.toml");
  };
  EXPECT_NEAR(lumens(scene_of("centre = [2, 2, 2]\n")), measured_lumens(), 1e-6);
  EXPECT_NEAR(lumens(scene_of("at = 'under the ceiling'\nlumen = 700\n")), 700, 1e-6);
  EXPECT_NEAR(lumens(scene_of("at = 'on the back wall'\nsize = [0.2, 0.2]\n")), measured_lumens(), 1e-6);
  EXPECT_NEAR(lumens(scene_of("centre = [2, 2, 2]\nradius = 0.1\n")), measured_lumens(), 1e-6);
  const Scene turned = scene_of("centre = [2, 2, 2]\nalong = [0, 3, -1]\n");
  EXPECT_NEAR(vec::dot(turned.lamps[0].x, {0, 0, -1}), 1, 1e-12) << "level";
  EXPECT_NEAR(vec::dot(turned.lamps[0].nadir, {0, -1, 0}), 1, 1e-12);
  vec::Box box;
  for (const SceneTriangle& t : turned.triangles)
    if (emits(turned.materials[t.material]))
      for (const std::uint32_t p : t.position) box.include(turned.positions[p]);
  EXPECT_NEAR(box.extent()[2], 1, 1e-9) << "its length runs along the turn's beginning";
  EXPECT_NEAR(box.extent()[0], 0.5, 1e-9);
}

TEST(Ies, LampsThatCannotHangAreRefused) {
  const auto refused_with = [](const std::string& keys) {
    return refusal({{"s.toml", "[room]\nsize = [4, 3, 5]\n[[lamp]]\n" + keys}, {"b.ies", kIes}}, "s.toml");
  };
  EXPECT_THAT(refused_with("ies = 'c.ies'\ncentre = [1, 1, 1]\n"),
              StartsWith("s.toml:3: there is no measured lamp 'c.ies'"));
  EXPECT_THAT(refused_with("ies = 'b.ies'\ncentre = [1, 1, 1]\nradiance = 1\n"),
              StartsWith("s.toml:6: [[lamp]] 'ies' says"));
  EXPECT_THAT(refused_with("lumen = 3\ncentre = [1, 1, 1]\nradius = 1\nalong = [1, 0, 0]\n"),
              StartsWith("s.toml:7: [[lamp]] 'along'"));
  const std::string parallel = "s.toml:6: [[lamp]] 'along' lies along where the lamp faces";
  EXPECT_THAT(refused_with("ies = 'b.ies'\ncentre = [1, 1, 1]\nalong = [0, 2, 0]\n"), StartsWith(parallel));
  EXPECT_THAT(refused_with("ies = 'b.ies'\nat = 'on the left wall'\nalong = [-1, 0, 0]\n"), StartsWith(parallel));
  EXPECT_THAT(refused_with("ies = 'b.ies'\ncentre = [1, 1, 1]\nalong = [1, 0, 2]\nfacing = [0.5, 0, 1]\n"),
              StartsWith(parallel));
  EXPECT_THAT(refused_with("ies = 'b.ies'\ncorner = [1, 1, 1]\nalong = [0, 0, 2]\nedges = [[0, 1, 0], [1, 0, 0]]\n"),
              StartsWith(parallel));
  EXPECT_THAT(refusal({{"a.mgf", "ies b.ies -m\n"}, {"b.ies", kIes}}, "a.mgf"), StartsWith("a.mgf:1: -m is followed"));
  EXPECT_THAT(refusal({{"a.mgf", "ies c.ies\n"}}, "a.mgf"), StartsWith("a.mgf:1: there is no measured lamp"));
}

}  // namespace
}  // namespace torolux
