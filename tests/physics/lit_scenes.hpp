// SPDX-License-Identifier: MIT
// What holds of scenes under every kind of light: the same picture on another machine, and that of the path tracer. A
// render's case enters.
#pragma once

#include <gtest/gtest.h>

#include "tests/references/path_tracer.hpp"
#include "tests/references/picture_error.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {

/// one: on one PE.
inline void expect_same_on_another_machine(RenderCase one) {
  const auto expected = bytes_of(run_case(one).picture);
  one.machine.columns = 3;
  one.machine.rows = 2;
  one.machine.subspaces = {5, 1, 4};
  EXPECT_EQ(bytes_of(run_case(one).picture), expected);
}

struct BesidePathTracer {
  RenderResult result;
  references::PictureError error;
};

/// With the scene's own camera, 1,024 paths a pixel.
inline BesidePathTracer beside_path_tracer(const RenderCase& room) {
  const Scene scene = load_scene(room.scene, {});
  references::TraceChoice choice;
  choice.width = room.quality.width;
  choice.height = room.quality.height;
  choice.samples = 1024;
  const auto reference = references::trace(references::World(scene, false), scene.camera.value(), choice);
  BesidePathTracer beside{run_case(room), {}};
  beside.error = references::picture_error(beside.result.picture, reference.picture);
  return beside;
}

}  // namespace torolux::test
