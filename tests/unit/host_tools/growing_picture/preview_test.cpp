// SPDX-License-Identifier: MIT
// Proves: a preview is what the finished picture of that state would be, only .png files are written, a writer that has
// been stopped writes no more, and of states only the newest is taken.
#include <gmock/gmock.h>

#include "host_tools/files/write_file.hpp"
#include "host_tools/growing_picture/preview_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux {
namespace {

using testing_support::TemporaryFolder;

PictureState half_done() {
  PictureState state{{4, 2, std::vector<std::array<float, 3>>(8)}, {{protocol::Plane::depth, {}, {}}}};
  for (std::size_t i = 0; i < 4; ++i) state.picture.pixels[i] = {1, 2, static_cast<float>(i)};
  state.layers[0].values.assign(8, {1, 0, 0});
  return state;
}

std::vector<std::byte> bytes(const std::filesystem::path& file) {
  return read_file(file, 1U << 20U);
}

TEST(Preview, IsWhatTheFinishedPictureWouldBe) {
  const TemporaryFolder folder;
  const PictureState state = half_done();
  const ToneMapping tone{1, ToneCurve::linear};
  write_preview(state, {folder.path() / "a.exr", folder.path() / "a.png"}, tone);
  EXPECT_EQ(folder.files(), 2U) << "the picture and its depth; no .exr";
  write_layers(state.picture, state.layers, folder.path() / "b.png", tone);
  EXPECT_EQ(bytes(folder.path() / "a.png"), bytes(folder.path() / "b.png"));
  EXPECT_EQ(bytes(folder.path() / "a_depth.png"), bytes(folder.path() / "b_depth.png"));
}

TEST(Preview, WritesInTheBackgroundUntilItIsStopped) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a.png";
  PreviewWriter writer({file}, {});
  writer.put(std::make_shared<PictureState>(half_done()));
  while (!std::filesystem::exists(file)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(writer.stop(), "");
  std::filesystem::remove(file);
  writer.put(std::make_shared<PictureState>(half_done()));
  EXPECT_EQ(writer.stop(), "");
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Preview, WhatCannotBeWrittenIsTold) {
  const TemporaryFolder folder;
  PreviewWriter writer({folder.path() / "gone" / "a.png"}, {});
  writer.put(std::make_shared<PictureState>(half_done()));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_THAT(writer.stop(), testing::HasSubstr("gone"));
}

TEST(Newest, IsWhatIsTaken) {
  Newest<int> newest;
  newest.put(std::make_shared<int>(1));
  newest.put(std::make_shared<int>(2));
  EXPECT_EQ(*newest.take(std::chrono::milliseconds(0)), 2);
  EXPECT_EQ(newest.take(std::chrono::milliseconds(0)), nullptr);
  newest.close();
  EXPECT_EQ(newest.take(std::chrono::hours(1)), nullptr);
}

}  // namespace
}  // namespace torolux
