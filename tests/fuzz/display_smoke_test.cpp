// SPDX-License-Identifier: MIT
// Paths of cameras and commands of the display's page, cut and changed at random (a fixed seed): nothing crashes, and
// all that is not taken is refused.
#include <gtest/gtest.h>

#include "tests/fuzz/load_display.hpp"
#include "tests/fuzz/smoke.hpp"

namespace torolux {
namespace {

TEST(FuzzSmoke, CameraPath) {
  smoke("camera_path", 5'000, load_camera_path_text);
}
TEST(FuzzSmoke, DisplayCommand) {
  smoke("display_command", 5'000, obey_command);
}

}  // namespace
}  // namespace torolux
