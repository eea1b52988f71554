// SPDX-License-Identifier: MIT
// Texts of scene files in; the scene, or the message of its refusal, out.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emulator/errors.hpp"
#include "host_tools/scene/load_scene.hpp"
#include "tests/support/memory_files.hpp"

namespace torolux {

using Texts = std::map<std::string, std::string>;

inline Scene load_texts(const Texts& texts, const std::string& name, bool studio = false) {
  MemoryFiles files(texts);
  SceneOptions options;
  options.studio = studio;
  return load_scene_from(files, name, options);
}

/// Of the InputError, or "(accepted)".
inline std::string refusal(const Texts& texts, const std::string& name) {
  try {
    load_texts(texts, name);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(accepted)";
}

/// A triangle in z = 0 whose front faces +z; four positions.
inline const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n";

inline double area(const Scene& scene, std::size_t t) {
  const auto& p = scene.triangles[t].position;
  Vec3d a = scene.positions[p[0]];
  Vec3d u{};
  Vec3d v{};
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = scene.positions[p[1]][i] - a[i];
    v[i] = scene.positions[p[2]][i] - a[i];
  }
  const Vec3d n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  return 0.5 * std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

}  // namespace torolux
