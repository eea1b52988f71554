// SPDX-License-Identifier: MIT
// What the programs share that make a whole scene, the same bytes every time: chance, and the folder of its files.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace scene_tools {

/// 32 bits to 32 bits, each of which depends on all (Wellons 2018, "lowbias32").
inline std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16U;
  x *= 0x7FEB'352DU;
  x ^= x >> 15U;
  x *= 0x846C'A68BU;
  return x ^ x >> 16U;
}

/// What `write` prints goes to a file.
inline bool write_file(const std::filesystem::path& path, void (*write)()) {
  // stdout itself is opened anew: nothing is owned here. NOLINTNEXTLINE(cppcoreguidelines-owning-memory)
  if (std::freopen(path.c_str(), "w", stdout) == nullptr) {
    std::perror(path.c_str());
    return false;
  }
  write();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return true;
  std::perror(path.c_str());
  return false;
}

/// What prints each of a scene's files.
struct SceneWriters {
  void (*mesh)();
  void (*materials)();
  void (*scene)();
};

/// The whole of `make_NAME FOLDER`: writes scene.toml, NAME.obj and NAME.mtl there. Returns the exit code.
inline int make_scene(int count, char** words, const std::string& name, const SceneWriters& writers) {
  if (count != 2) {
    std::fprintf(stderr, "make_%s FOLDER: writes scene.toml, %s.obj and .mtl there\n", name.c_str(), name.c_str());
    return EXIT_FAILURE;
  }
  const std::filesystem::path folder = words[1];
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const bool done = write_file(folder / (name + ".obj"), writers.mesh) &&
                    write_file(folder / (name + ".mtl"), writers.materials) &&
                    write_file(folder / "scene.toml", writers.scene);
  return done ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace scene_tools
