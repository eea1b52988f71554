// SPDX-License-Identifier: MIT
// A scene's folder and the name of a file enter; the scene leaves as a .glb, as tests of formats write it.
#include <exception>
#include <iostream>

#include "host_tools/files/write_file.hpp"
#include "host_tools/scene/load_scene.hpp"
#include "tests/support/written_scenes.hpp"

int main(int count, char** arguments) {
  if (count != 3) {
    std::cerr << "write_glb SCENE FILE.glb\n";
    return 1;
  }
  try {
    torolux::write_file(arguments[2], torolux::as_glb(torolux::load_scene(arguments[1], {})));
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
