// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cstdio>
#include <chrono>
#include "tests/references/path_tracer.hpp"
#include "tests/references/picture_error.hpp"
#include "host_tools/scene/load_scene.hpp"
using namespace torolux; using namespace torolux::references;
TEST(X, Y) {
  const Scene scene = load_scene(std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes/cornell_box", {});
  World world(scene, false);
  auto t0 = std::chrono::steady_clock::now();
  auto p = trace(world, *scene.camera, {64,64,256,1,1,LightFinding::both});
  std::printf("%g s noise %g\n", std::chrono::duration<double>(std::chrono::steady_clock::now()-t0).count(), reference_noise(p));
  write_picture(p.picture, "/tmp/wtR_x.png", 0);
  auto q = trace(world, *scene.camera, {64,64,256,1,1,LightFinding::emitters_only});
  auto r = trace(world, *scene.camera, {64,64,256,1,1,LightFinding::directions_only});
  auto e = picture_error(q.picture, p.picture); std::printf("nee %g %g\n", e.mean, e.rmse);
  e = picture_error(r.picture, p.picture); std::printf("bsdf %g %g\n", e.mean, e.rmse);
}
