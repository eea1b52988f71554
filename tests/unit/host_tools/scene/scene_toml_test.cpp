// SPDX-License-Identifier: MIT
// Proves what scene.toml does to meshes, materials, lights and camera, and that every mistake is refused with its line.
#include <set>

#include "host_tools/scene/camera.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kMesh = "[[mesh]]\nfile = 'a.obj'\n";

Scene with(const std::string& toml) {
  return load_texts({{"d/scene.toml", toml}, {"d/a.obj", kTriangle}}, "d/scene.toml");
}

std::string refused(const std::string& toml) {
  return refusal({{"s.toml", toml}, {"a.obj", kTriangle}}, "s.toml");
}

Vec3d corner(const Scene& scene, std::size_t triangle, std::size_t i) {
  return scene.positions[scene.triangles[triangle].position[i]];
}

Vec3d front(const Scene& scene, std::size_t triangle) {
  const Vec3d a = corner(scene, triangle, 0);
  return vec::unit(
      vec::cross(vec::subtract(corner(scene, triangle, 1), a), vec::subtract(corner(scene, triangle, 2), a)));
}

TEST(SceneToml, TransformScalesThenTurnsThenMoves) {
  const Scene scene = with(kMesh + "scale = 2\nrotate = [90, 0, 90]\ntranslate = [10, 20, 30]\n");
  // (1, 1, 0) * 2 = (2, 2, 0); about x by 90: (2, 0, 2); about z by 90: (0, 2, 2).
  EXPECT_EQ(corner(scene, 0, 2), (Vec3d{10, 22, 32}));
}

TEST(SceneToml, MirroredScaleKeepsTheFrontOutwards) {
  // The mesh mirrored in x: what was seen counter-clockwise from +z still is.
  EXPECT_EQ(front(with(kMesh + "scale = [-1, 1, 1]\n"), 0), (Vec3d{0, 0, 1}));
  EXPECT_EQ(front(with(kMesh + "scale = [1, 1, -1]\n"), 0), (Vec3d{0, 0, -1}));
  EXPECT_EQ(front(with(kMesh + "flip = true\n"), 0), (Vec3d{0, 0, -1}));
}

TEST(SceneToml, SeveralMeshes) {
  const Scene scene = with(kMesh + kMesh + "translate = [0, 0, 1]\n");
  EXPECT_EQ(scene.triangles.size(), 2U);
}

TEST(SceneToml, InstancesAreTheMeshPlacedAnew) {
  const std::string instances =
      "scale = 2\ntranslate = [0, 0, 1]\n"
      "[[mesh.instance]]\n"
      "[[mesh.instance]]\ntranslate = [0, 0, 7]\nmaterial = 'red'\n"
      "[[mesh.instance]]\nscale = 3\ntranslate = [0, 0, 2]\nflip = true\n[material.red]\ndiffuse = 0.5\n";
  const Scene scene = with(kMesh + instances);
  ASSERT_EQ(scene.triangles.size(), 3U) << "as many as there are instances";
  const auto corners = [&](std::size_t t) {
    return std::set<Vec3d>{corner(scene, t, 0), corner(scene, t, 1), corner(scene, t, 2)};
  };
  EXPECT_EQ(corners(0), (std::set<Vec3d>{{0, 0, 1}, {2, 0, 1}, {2, 2, 1}})) << "what it does not say, the mesh says";
  EXPECT_EQ(corners(1), (std::set<Vec3d>{{0, 0, 7}, {2, 0, 7}, {2, 2, 7}})) << "what it says is in the mesh's place";
  EXPECT_EQ(corners(2), (std::set<Vec3d>{{0, 0, 2}, {3, 0, 2}, {3, 3, 2}}));
  EXPECT_EQ(front(scene, 1), (Vec3d{0, 0, 1}));
  EXPECT_EQ(front(scene, 2), (Vec3d{0, 0, -1}));
  EXPECT_EQ(scene.materials.size(), 2U) << "instances share them";
  EXPECT_EQ(scene.materials[scene.triangles[1].material].name, "red");
  EXPECT_NE(scene.materials[scene.triangles[0].material].name, "red");

  EXPECT_THAT(refused(kMesh + "[[mesh.instance]]\nfile = 'b.obj'\n"),
              StartsWith("s.toml:4: [[mesh.instance]] has no key 'file'"));
  EXPECT_THAT(refused(kMesh + "[[mesh.instance]]\nscale = 0\n"),
              StartsWith("s.toml:4: [[mesh.instance]] 'scale' is zero"));
}

TEST(SceneToml, MaterialOverridesByName) {
  const Texts texts{{"s.toml", kMesh + "[material.m]\nmirror = [0.9, 0.8, 0.7]\n"},
                    {"a.obj", "mtllib a.mtl\nusemtl m\n" + kTriangle},
                    {"a.mtl", "newmtl m\nKd 0.5 0.5 0.5\n"}};
  const Scene scene = load_texts(texts, "s.toml");
  EXPECT_EQ(scene.materials[0].kind, SurfaceKind::mirror);
  EXPECT_EQ(scene.materials[0].specular, (Vec3d{0.9, 0.8, 0.7}));
  EXPECT_EQ(scene.materials[0].diffuse, (Vec3d{0, 0, 0}));
}

TEST(SceneToml, MaterialForAMeshWithoutLibrary) {
  const Scene scene = with(kMesh + "material = 'gold'\n[material.gold]\ndiffuse = 0.25\nemission = [3, 2, 1]\n");
  EXPECT_EQ(scene.materials[0].diffuse, (Vec3d{0.25, 0.25, 0.25}));
  EXPECT_EQ(scene.materials[0].emission, (Vec3d{3, 2, 1}));
}

TEST(SceneToml, GlossyStandsBesideDiffuse) {
  const Texts texts{{"s.toml", kMesh + "[material.m]\nglossy = [0.1, 0.2, 0.3]\nexponent = 40\n"},
                    {"a.obj", "mtllib a.mtl\nusemtl m\n" + kTriangle},
                    {"a.mtl", "newmtl m\nKd 0.5 0.5 0.5\n"}};
  const SceneMaterial material = load_texts(texts, "s.toml").materials[0];
  EXPECT_TRUE(is_glossy(material));
  EXPECT_EQ(material.specular, (Vec3d{0.1, 0.2, 0.3}));
  EXPECT_DOUBLE_EQ(material.exponent, 40);
  EXPECT_DOUBLE_EQ(material.diffuse[0], 0.5);
  const std::string gold = kMesh + "material = 'gold'\n[material.gold]\n";
  EXPECT_FALSE(is_glossy(with(gold + "diffuse = 0.25\n").materials[0]));
  EXPECT_THAT(refusal({{"s.toml", gold + "glossy = 0.5\nmirror = 0.5\n"}, {"a.obj", kTriangle}}, "s.toml"),
              HasSubstr("not beside mirror or glass"));
  EXPECT_THAT(refusal({{"s.toml", gold + "exponent = 5\n"}, {"a.obj", kTriangle}}, "s.toml"),
              HasSubstr("which only glossy uses"));
}

TEST(SceneToml, MaterialsAreRenamedPerMesh) {
  const Scene scene = with(kMesh + "materials = {'(none)' = 'clear'}\n[material.clear]\nglass = 1.33\n" + kMesh +
                           "translate = [0, 0, 1]\n");
  ASSERT_EQ(scene.materials.size(), 2U);
  EXPECT_EQ(scene.materials[0].kind, SurfaceKind::glass);
  EXPECT_DOUBLE_EQ(scene.materials[0].refractive_index, 1.33);
  EXPECT_EQ(scene.materials[1].kind, SurfaceKind::diffuse);
}

TEST(SceneToml, LightByCornerAndEdgesFacesTheCrossProduct) {
  const Scene scene = with(kMesh + "[[light]]\ncorner = [0, 2, 0]\nedges = [[1, 0, 0], [0, 0, 1]]\nradiance = 5\n");
  ASSERT_EQ(scene.triangles.size(), 3U);
  EXPECT_EQ(front(scene, 1), (Vec3d{0, -1, 0}));
  EXPECT_EQ(front(scene, 2), (Vec3d{0, -1, 0}));
  EXPECT_EQ(scene.materials[scene.triangles[1].material].emission, (Vec3d{5, 5, 5}));
  EXPECT_NO_THROW(check_renderable(scene));
}

TEST(SceneToml, LightByCentreFacesAsSaid) {
  for (const Vec3d facing : {Vec3d{0, -1, 0}, Vec3d{0, 1, 0}, Vec3d{1, 0, 0}, Vec3d{0, 0, -1}, Vec3d{1, 2, -2}}) {
    const std::string vector =
        std::to_string(facing[0]) + "," + std::to_string(facing[1]) + "," + std::to_string(facing[2]);
    const Scene scene =
        with(kMesh + "[[light]]\ncentre = [0, 2, 0]\nsize = [3, 0.5]\nfacing = [" + vector + "]\nradiance = [1,2,3]\n");
    EXPECT_NEAR(vec::dot(front(scene, 1), vec::unit(facing)), 1, 1e-12);
    EXPECT_NEAR(area(scene, 1) + area(scene, 2), 1.5, 1e-12);
  }
}

TEST(SceneToml, ALensIsFocusedOnAPointADistanceOrWhatItLooksAt) {
  const auto camera = [](const std::string& more) {
    return with(kMesh + "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 1]\n" + more).camera.value();
  };
  EXPECT_EQ(camera("").aperture, 0);
  EXPECT_EQ(camera("aperture = 0.1\n").aperture, 0.1);
  EXPECT_EQ(focus_distance(camera("aperture = 0.1\n")), 4);
  EXPECT_EQ(focus_distance(camera("aperture = 0.1\nfocus = 2.5\n")), 2.5);
  EXPECT_EQ(focus_distance(camera("aperture = 0.1\nfocus = [3, 1, 2]\n")), 3);
  const auto refused_camera = [](const std::string& more) {
    return refused(kMesh + "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 1]\n" + more);
  };
  EXPECT_THAT(refused_camera("aperture = -1\n"), HasSubstr("aperture"));
  EXPECT_THAT(refused_camera("aperture = 1\nfocus = 0\n"), HasSubstr("focused on what does not lie before it"));
  EXPECT_THAT(refused_camera("aperture = 1\nfocus = [0, 0, 6]\n"), HasSubstr("focused on what does not lie before it"));
  EXPECT_THAT(refused_camera("focus = 'far'\n"), HasSubstr("a number or an array of three numbers"));
}

TEST(SceneToml, WhiteBalanceIsKelvinOrAWord) {
  const auto white = [](const std::string& value) {
    return with(kMesh + "[defaults]\nwhite_balance = " + value + "\n").defaults.given.get(&ToneMapping::white);
  };
  EXPECT_EQ(white("3000"), (WhiteBalance{WhiteBalance::Kind::kelvin, 3000}));
  EXPECT_EQ(white("'auto'"), (WhiteBalance{WhiteBalance::Kind::automatic, 0}));
  EXPECT_EQ(white("'off'"), WhiteBalance{});
  EXPECT_THAT(refused(kMesh + "[defaults]\nwhite_balance = 'warm'\n"), HasSubstr("expected kelvin, \"auto\""));
  EXPECT_THAT(refused(kMesh + "[defaults]\nwhite_balance = 10\n"), HasSubstr("white_balance"));
}

TEST(SceneToml, CameraAndDefaults) {
  const Scene scene =
      with("name = 'x'\n" + kMesh +
           "[camera]\neye = [1, 2, 3]\nlook_at = [0, 0, 0]\nup = [0, 0, 1]\nfov = 30\n"
           "[defaults]\nwidth = 64\nheight = 32\nsamples = 9\nhemicube = 32\nshot_points = 3\nemission_records = "
           "6\nmax_shots = 7\nbounces = 8\n"
           "exposure = -1.5\npatches = 0.5\nelements = 0.25\nunshot = 0.05\nsubspaces = '2x2x2'\nallocation = 'block'\n"
           "two_sided_lights = true\nshadow_rays = true\nfilter = 'tent'\nseed = 5\n");
  EXPECT_EQ(scene.name, "x");
  const Camera camera = scene.camera.value_or(Camera{});
  EXPECT_EQ(camera.eye, (Vec3d{1, 2, 3}));
  EXPECT_EQ(camera.up, (Vec3d{0, 0, 1}));
  EXPECT_EQ(camera.field_of_view_degrees, 30);
  const SceneDefaults& defaults = scene.defaults;
  const auto given = [&defaults](auto member) { return defaults.given.get(member); };
  EXPECT_EQ(given(&Quality::width), 64U);
  EXPECT_EQ(given(&Quality::height), 32U);
  EXPECT_EQ(given(&Quality::samples), 9U);
  EXPECT_EQ(given(&Quality::hemicube), 32U);
  EXPECT_EQ(given(&Quality::shot_points), 3U);
  EXPECT_EQ(given(&Quality::emission_records), 6U);
  EXPECT_EQ(given(&Quality::max_shots), 7U);
  EXPECT_EQ(given(&Quality::bounces), 8U);
  EXPECT_EQ(given(&ToneMapping::exposure_ev), -1.5);
  EXPECT_EQ(given(&Quality::patch_length).value(), 0.5);
  EXPECT_EQ(given(&Quality::element_length).value(), 0.25);
  EXPECT_EQ(given(&Quality::unshot), 0.05);
  EXPECT_EQ(given(&Quality::two_sided_lights), true);
  EXPECT_EQ(given(&Quality::shadow_rays), true);
  EXPECT_EQ(given(&Quality::filter), PixelFilter::tent);
  EXPECT_EQ(given(&Quality::seed), 5U);
  EXPECT_EQ(given(&Quality::texels), std::nullopt) << "not said";
  EXPECT_EQ(defaults.subspaces.value().text, "2x2x2");
  EXPECT_THAT(defaults.subspaces.value().place, testing::MatchesRegex(".*:[0-9]+"));
  EXPECT_EQ(defaults.allocation.value().text, "block");
}

TEST(SceneToml, TheFolderNamesTheScene) {
  EXPECT_EQ(with(kMesh).name, "d");
}

TEST(SceneToml, ANameThatNoPictureCanHaveIsRefused) {
  for (const char* name : {"", "  ", "a/b", "a\\nb"})
    EXPECT_THAT(
        refusal({{"s.toml", "\nname = \"" + std::string(name) + "\"\n" + kMesh}, {"a.obj", kTriangle}}, "s.toml"),
        StartsWith("s.toml:2: the scene's 'name' is"))
        << name;
}

TEST(SceneToml, UnknownKeysAreRefusedWithTheNearest) {
  EXPECT_THAT(refused("[[mesh]]\nfile = 'a.obj'\ntranslat = [0, 0, 0]\n"),
              AllOf(StartsWith("s.toml:3: "), HasSubstr("did you mean 'translate'?")));
  EXPECT_THAT(refused(kMesh + "[[light]]\nradience = 5\n"),
              AllOf(StartsWith("s.toml:3: [[light]] lacks 'radiance'"), HasSubstr("did you mean it by 'radience'?")));
  EXPECT_THAT(refused(kMesh + "[material.m]\nDifuse = 0.5\n"), HasSubstr("did you mean 'diffuse'?"));
  EXPECT_THAT(refused("[camra]\neye = [0, 0, 0]\n"), AllOf(StartsWith("s.toml:1: "), HasSubstr("'camera'")));
  EXPECT_THAT(refused(kMesh + "[defaults]\nfilter = 'round'\n"),
              AllOf(StartsWith("s.toml:4: [defaults] 'filter': "), HasSubstr("round")));
  EXPECT_THAT(refused(kMesh + "[defaults]\nwidht = 3\n"), AllOf(StartsWith("s.toml:4: "), HasSubstr("'width'")));
}

TEST(SceneToml, RefusalsNameFileAndLine) {
  EXPECT_THAT(refused("[[mesh]\n"), StartsWith("s.toml:1: not valid TOML"));
  EXPECT_THAT(refused("\n[[mesh]]\nscale = 1\n"), StartsWith("s.toml:2: [[mesh]] lacks 'file'"));
  EXPECT_THAT(refused("[[mesh]]\nfile = 3\n"), StartsWith("s.toml:2: [[mesh]] 'file' must be a text"));
  EXPECT_THAT(refused("[[mesh]]\nfile = 'b.obj'\n"), StartsWith("s.toml:1: there is no file 'b.obj'"));
  EXPECT_THAT(refused("[[mesh]]\nfile = 'b.ply'\n"),
              StartsWith("s.toml:1: 'b.ply' is not an .obj, .gltf, .glb or .mgf"));
  EXPECT_THAT(refused("[mesh]\nfile = 'a.obj'\n"), HasSubstr("the scene 'mesh' must be written as [[mesh]]"));
  EXPECT_THAT(refused(kMesh + "instance = 3\n"), HasSubstr("[[mesh]] 'instance' must be written as [[mesh.instance]]"));
  EXPECT_THAT(refused(kMesh + "scale = 0\n"), StartsWith("s.toml:3: [[mesh]] 'scale' is zero"));
  EXPECT_THAT(refused(kMesh + "scale = [1, 0, 1]\n"), HasSubstr("'scale' is zero"));
  EXPECT_THAT(refused(kMesh + "translate = [1, 2]\n"), HasSubstr("array of three numbers"));
  EXPECT_THAT(refused(kMesh + "translate = [nan, 0, 0]\n"), StartsWith("s.toml:3: "));
  EXPECT_THAT(refused(kMesh + "translate = [inf, 0, 0]\n"), StartsWith("s.toml:3: "));
  EXPECT_THAT(refused(kMesh + "material = 'gold'\n"), HasSubstr("material 'gold' is not defined"));
  EXPECT_THAT(refused(kMesh + "[material.m]\ndiffuse = -1\n"), StartsWith("s.toml:4: "));
  EXPECT_THAT(refused(kMesh + "[material.m]\ndiffuse = 0.5\nmirror = 0.5\n"), HasSubstr("one of diffuse, mirror"));
  EXPECT_THAT(refused(kMesh + "[material]\nm = 3\n"), HasSubstr("write [material.m]"));
  EXPECT_THAT(refused(kMesh + "[[light]]\nradiance = 1\n"), HasSubstr("needs either 'corner' and 'edges'"));
  EXPECT_THAT(refused(kMesh + "[[light]]\nradiance = 0\n"), HasSubstr("'radiance' is zero"));
  EXPECT_THAT(refused(kMesh + "[[light]]\nradiance = 1\ncentre = [0, 0, 0]\nsize = [0, 1]\nfacing = [0, 1, 0]\n"),
              HasSubstr("has no area"));
  EXPECT_THAT(refused(kMesh + "[camera]\neye = [1, 1, 1]\nlook_at = [1, 1, 1]\n"), HasSubstr("looks nowhere"));
  EXPECT_THAT(refused(kMesh + "[camera]\neye = [0, 1, 0]\nlook_at = [0, 0, 0]\n"), HasSubstr("along its own up"));
  EXPECT_THAT(refused(kMesh + "[camera]\neye = [0, 1, 0]\nlook_at = [0, 0, 0]\nfov = 180\n"), HasSubstr("'fov'"));
  EXPECT_THAT(refused(kMesh + "[defaults]\nhemicube = 7\n"),
              StartsWith("s.toml:4: [defaults] 'hemicube' must be even"));
  EXPECT_THAT(refused(kMesh + "[defaults]\nwidth = 0\n"), HasSubstr("allowed are 1 to 32768"));
  EXPECT_THAT(refused(kMesh + "[defaults]\nseed = -1\n"), StartsWith("s.toml:4: "));
  EXPECT_THAT(refused("name = 'nothing'\n"), HasSubstr("nothing to render"));
  EXPECT_THAT(refused(std::string(5000, 'a') + "." + std::string(300, '.') + "\n"), StartsWith("s.toml:1: "));
}

TEST(SceneToml, AnUnusedMaterialIsTold) {
  EXPECT_THAT(with(kMesh + "[material.m]\ndiffuse = 0.5\n").warnings,
              Contains(HasSubstr("scene.toml:3: no face uses material 'm'")));
}

}  // namespace
}  // namespace torolux
