// SPDX-License-Identifier: MIT
// Proves: a path's cameras stand where its file says, with pictures between them on a smooth way; what a path may not
// say is refused with its line.
#include <gtest/gtest.h>

#include <filesystem>

#include "emulator/errors.hpp"
#include "host_tools/cli/path_frames.hpp"
#include "host_tools/scene/camera.hpp"
#include "host_tools/scene/camera_path.hpp"

namespace torolux::test {
namespace {

std::string key(double x, const std::string& more = "") {
  return "[[camera]]\neye = [" + std::to_string(x) + ", 0, 5]\nlook_at = [0, 0, 0]\n" + more + "\n";
}

std::vector<double> eyes(const std::string& text) {
  std::vector<double> x;
  for (const Camera& camera : read_camera_path(text, "walk.toml", {})) x.push_back(camera.eye[0]);
  return x;
}

TEST(CameraPath, EqualStepsBetweenCamerasInARow) {
  EXPECT_EQ(eyes(key(1)), (std::vector<double>{1}));
  EXPECT_EQ(eyes(key(1) + key(3)), (std::vector<double>{1, 3}));
  // Uniform Catmull-Rom of points at equal distances is the straight line, but for its two ends.
  const std::vector<double> x = eyes(key(0) + key(4, "frames = 4") + key(8) + key(12));
  ASSERT_EQ(x.size(), 7U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(x[i + 1], 4 + static_cast<double>(i), 1e-12);
}

TEST(CameraPath, AClosedOneGoesBackToTheFirst) {
  const std::vector<double> x = eyes("closed = true\n" + key(0, "frames = 2") + key(4, "frames = 2"));
  ASSERT_EQ(x.size(), 4U);
  EXPECT_NEAR(x[1], 2, 1e-12);
  EXPECT_NEAR(x[3], 2, 1e-12);
}

TEST(CameraPath, WhatIsNotSaidIsThatOfTheCameraBefore) {
  Camera scene;
  scene.field_of_view_degrees = 33;
  const auto cameras = read_camera_path(key(1) + key(2, "fov = 50") + key(3), "walk.toml", scene);
  EXPECT_EQ(cameras.at(0).field_of_view_degrees, 33);
  EXPECT_EQ(cameras.at(1).field_of_view_degrees, 50);
  EXPECT_EQ(cameras.at(2).field_of_view_degrees, 50);
}

TEST(CameraPath, TheLensGoesAlongAsWell) {
  const auto cameras = read_camera_path(key(0, "aperture = 0.1\nfocus = 1") + key(4, "focus = 2\nframes = 2") +
                                            key(8, "focus = 3") + key(12, "focus = 4"),
                                        "walk.toml", {});
  ASSERT_EQ(cameras.size(), 5U);
  for (const Camera& camera : cameras) EXPECT_NEAR(camera.aperture, 0.1, 1e-12);
  EXPECT_NEAR(focus_distance(cameras[2]), 2.5, 1e-12);
  const auto followed =
      read_camera_path(key(0, "frames = 2\naperture = 1\nfocus = [9, 0, -7]") + key(4), "walk.toml", {});
  ASSERT_EQ(followed.size(), 3U);
  EXPECT_EQ(followed[1].focus, followed[0].focus) << "the point stays in focus";
}

std::string refusal(const std::string& text) {
  try {
    read_camera_path(text, "walk.toml", {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CameraPath, SaysWhatIsWrongAndWhere) {
  for (const auto& [text, wanted] : std::vector<std::pair<std::string, std::string>>{
           {"", "walk.toml"},
           {"[[camera]]\nlook_at = [0, 0, 0]", "walk.toml:1"},
           {key(1) + key(2, "frames = 2"), "walk.toml:5"},
           {key(1, "frames = 0") + key(2), "walk.toml:4"},
           {key(1, "frams = 3"), "frams"},
           {key(1, "frames = 99999") + key(2, "frames = 2") + key(3), "100001"},
           {"[[camera]]\neye = [1, 0, 0]\nlook_at = [1, 0, 0]", "looks nowhere"},
           // Half way its eye and what it looks at meet.
           {"[[camera]]\neye = [0, 0, 2]\nlook_at = [0, 0, 0]\nframes = 2\n"
            "[[camera]]\neye = [0, 0, -2]\nlook_at = [0, 0, 0]\n",
            "picture 1 after it looks nowhere"}}) {
    EXPECT_NE(refusal(text).find(wanted), std::string::npos) << text << "\n" << refusal(text);
  }
}

TEST(CameraPath, FilesAreNumbered) {
  EXPECT_EQ(frame_file("a/walk.png", 7, 20), "a/walk.0007.png");
  EXPECT_EQ(frame_file("walk.tar.exr", 7, 20), "walk.tar.0007.exr");
  EXPECT_EQ(frame_file("walk.png", 7, 12345), "walk.00007.png");
}

}  // namespace
}  // namespace torolux::test
