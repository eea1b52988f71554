// SPDX-License-Identifier: MIT
// The words of a command line enter; its exit code and what it printed leave. And a scene that is enough for one.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "host_tools/cli/command.hpp"

namespace torolux {

struct Outcome {
  int code;
  std::string out, err;
};

inline Outcome torolux(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "torolux");
  std::vector<const char*> argv;
  argv.reserve(arguments.size());
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = torolux_main(static_cast<int>(argv.size()), argv.data());
  return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

/// A room with a lamp: enough to get past the scene.
inline std::filesystem::path write_small_scene(const std::filesystem::path& folder) {
  std::ofstream(folder / "room.mtl") << "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n";
  std::ofstream(folder / "room.obj") << "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\n"
                                        "usemtl wall\nf 1 2 3\nusemtl lamp\nf 6 5 4\n";
  return folder / "room.obj";
}

}  // namespace torolux
