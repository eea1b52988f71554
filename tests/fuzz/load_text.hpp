// SPDX-License-Identifier: MIT
// What fuzzers do with one input: load it as a part of a scene. Only an InputError may come out, and it must say where.
#pragma once

#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include "emulator/errors.hpp"
#include "host_tools/scene/inspect.hpp"
#include "host_tools/scene/load_scene.hpp"
#include "host_tools/scene/mgf.hpp"
#include "tests/support/memory_files.hpp"

namespace torolux {

enum class SceneText { obj, mtl, mgf, scene_toml, texture, gltf, ies };

inline std::map<std::string, std::string> scene_with(SceneText kind, const std::string& text) {
  const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\n";
  const std::string lamp = "TILT=NONE\n1 1000 1 2 1 1 1 0 0 0\n1 1 1\n0 90\n0\n100 50\n";
  const std::string library = "newmtl white\nKd .5 .5 .5\nnewmtl light\nKe 1 1 1\nnewmtl glass\nillum 7\nNi 1.5\n";
  switch (kind) {
    case SceneText::obj:
      return {{"fuzz.obj", text}, {"a.mtl", library}};
    case SceneText::mtl:
      return {{"fuzz.obj", "mtllib fuzz.mtl\n" + quad + "usemtl m\nf 1//1 2//1 3//1\nusemtl n\nf 1 3 4\n"},
              {"fuzz.mtl", text}};
    case SceneText::mgf:
      return {{"fuzz.mgf", text},
              {"a.inc", "v a =\np 0 0 0\nn 0 0 1\nv b =\np 1 0 0\nv c =\np 1 1 0\nm light =\ned 100\nf a b c\n"},
              {"a.ies", lamp}};
    case SceneText::ies:
      return {{"a.mgf", "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nm white =\nrd 0.5\nf a b c\nies fuzz.ies\n"},
              {"fuzz.ies", text}};
    case SceneText::texture:
      return {{"fuzz.obj", "mtllib a.mtl\n" + quad + "vt 0 0\nvt 2 0\nvt 2 2\nusemtl m\nf 1/1 2/2 3/3\n"},
              {"a.mtl", "newmtl m\nKd .5 .5 .5\nmap_Kd fuzz.png\n"},
              {"fuzz.png", text}};
    case SceneText::gltf:  // or a .glb: the first bytes decide
      return {{"fuzz.gltf", text}, {"a.bin", std::string(400, '\0')}};
    case SceneText::scene_toml:
      break;
  }
  return {{"fuzz.toml", text},
          {"a.obj", "mtllib a.mtl\n" + quad + "usemtl white\nf 1 2 3\nusemtl light\nf 1 3 4\n"},
          {"a.mtl", library},
          {"a.ies", lamp}};
}

/// Ends the program where a message does not begin with one of the files.
inline void check_place(const InputError& error) {
  const std::string message = error.what();
  for (const char* file : {"fuzz.", "a.obj", "a.mtl", "a.mgf", "a.inc", "--studio"})
    if (message.starts_with(file)) return;
  std::cerr << "a message without a place: " << message << '\n';
  std::abort();
}

/// true: loaded.
inline bool load_text(SceneText kind, const std::string& text, bool studio) {
  MemoryFiles files(scene_with(kind, text));
  SceneOptions options;
  options.studio = studio;
  try {
    const char* const named = kind == SceneText::scene_toml ? "fuzz.toml"
                              : kind == SceneText::gltf     ? "fuzz.gltf"
                              : kind == SceneText::mgf      ? "fuzz.mgf"
                              : kind == SceneText::ies      ? "a.mgf"
                                                            : "fuzz.obj";
    const Scene scene = load_scene_from(files, named, options);
    for (const SceneTriangle& triangle : scene.triangles)
      for (const std::uint32_t p : triangle.position)
        if (p >= scene.positions.size()) std::abort();
    inspect(scene);
    return true;
  } catch (const InputError& error) {
    check_place(error);
    return false;
  }
}

/// The same of MGF, whose arrays and curves make much of little: it is imported with narrow limits, and only a scene of
/// few triangles goes through all that scenes go through. One text in 256, chosen by its bytes, has wider limits.
inline bool load_mgf(const std::string& text, bool studio) {
  const bool wide = std::hash<std::string>()(text) % 256 == 0;
  const std::size_t most_triangles = wide ? 1'000 : 300;
  MemoryFiles files(scene_with(SceneText::mgf, text));
  Notices notices;
  try {
    const MgfLimits limits = wide ? MgfLimits{100'000, 100'000} : MgfLimits{10'000, 2'000};
    const ImportedMesh mesh = import_mgf("fuzz.mgf", files, {"fuzz.mgf"}, notices, limits);
    for (const ImportedTriangle& triangle : mesh.triangles)
      for (const std::uint32_t p : triangle.position)
        if (p >= mesh.positions.size()) std::abort();
    if (mesh.triangles.size() > most_triangles) return true;
  } catch (const InputError& error) {
    check_place(error);
    return false;
  }
  return load_text(SceneText::mgf, text, studio);
}

}  // namespace torolux
