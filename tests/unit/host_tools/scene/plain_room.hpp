// SPDX-License-Identifier: MIT
// A plain scene as texts, and what a scene of other texts is compared with it by: all that a picture depends on, and
// the notes on what was passed over or read otherwise.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {

inline const std::string kLibrary = "newmtl wall\nKd 0.5 0.25 0.75\nnewmtl lamp\nKd 0 0 0\nKe 8 8 8\n";
inline const std::string kPoints = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\n";
inline const std::string kFaces = "usemtl wall\nf 1 2 3 4\nusemtl lamp\nf 5 6 7\n";
inline const std::string kObj = "mtllib room.mtl\n" + kPoints + kFaces;

inline Scene load(const Texts& texts) {
  return load_texts(texts, texts.count("room.toml") > 0 ? "room.toml" : "room.obj");
}

/// All but that on the camera.
inline std::vector<std::string> notes(const Scene& scene) {
  std::vector<std::string> told = scene.warnings;
  std::erase_if(told, [](const std::string& note) { return note.find("names no camera") != std::string::npos; });
  return told;
}

/// Everything that a picture depends on.
inline void expect_same(const Scene& scene, const Scene& plain) {
  EXPECT_EQ(scene.positions, plain.positions);
  EXPECT_EQ(scene.normals, plain.normals);
  EXPECT_EQ(scene.texture_points, plain.texture_points);
  ASSERT_EQ(scene.triangles.size(), plain.triangles.size());
  for (std::size_t i = 0; i < plain.triangles.size(); ++i) {
    EXPECT_EQ(scene.triangles[i].position, plain.triangles[i].position);
    EXPECT_EQ(scene.triangles[i].normal, plain.triangles[i].normal);
    EXPECT_EQ(scene.triangles[i].texture_points, plain.triangles[i].texture_points);
    SceneMaterial material = scene.materials[scene.triangles[i].material];
    const SceneMaterial& expected = plain.materials[plain.triangles[i].material];
    material.name = expected.name;
    // tinyobjloader's decimal numbers are off by an ulp or two, toml++'s are not.
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(material.diffuse[c], expected.diffuse[c], 1e-12);
    material.diffuse = expected.diffuse;
    EXPECT_EQ(material, expected) << "triangle " << i;
  }
}

/// These are the beginnings of all its notes.
inline void expect_told(const Scene& scene, const std::vector<std::string>& beginnings) {
  const std::vector<std::string> told = notes(scene);
  ASSERT_EQ(told.size(), beginnings.size()) << testing::PrintToString(told);
  for (std::size_t i = 0; i < told.size(); ++i) EXPECT_THAT(told[i], testing::StartsWith(beginnings[i]));
}

/// All that stands for `from` stands for `to`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace torolux
