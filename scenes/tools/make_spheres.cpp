// SPDX-License-Identifier: MIT
// Writes scenes/cornell_spheres/spheres.obj: a mirror and a glass sphere, tessellated, with normals.
#include "scenes/tools/unit_sphere.hpp"

using scene_tools::ObjWriter;
using scene_tools::sphere;

int main() {
  std::printf("# Made by scenes/tools/make_spheres.cpp. They float 0.5 above the floor.\n");
  ObjWriter writer("spheres.mtl");
  writer.group("mirror_sphere");
  writer.material("mirror");
  sphere(writer, {400, 105.5, 375}, 105, 4);
  writer.group("glass_sphere");
  writer.material("glass");
  sphere(writer, {165, 105.5, 195}, 105, 4);
  return 0;
}
