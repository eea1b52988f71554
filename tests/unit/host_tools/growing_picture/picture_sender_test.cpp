// SPDX-License-Identifier: MIT
// Proves: a viewer written from the protocol has the whole picture at the end, whether it was there from the beginning,
// came late, went and came again; only what has changed is sent; one that never reads, or none, holds nothing up.
#include "host_tools/growing_picture/picture_sender.hpp"

#include <gmock/gmock.h>

#include <cstring>

#include "emulator/errors.hpp"
#include "host_tools/growing_picture/viewer_messages.hpp"
#include "tests/support/viewer_reader.hpp"

namespace torolux {
namespace {

using testing_support::ViewedPicture;
using testing_support::ViewerReader;

constexpr std::uint32_t kWidth = 300, kHeight = 200;  // 3 x 2 tiles, the last of a row or column cut

std::shared_ptr<PictureState> state_of(float value, std::uint32_t width = kWidth, std::uint32_t height = kHeight) {
  auto state = std::make_shared<PictureState>();
  state->picture = {width, height, {}};
  Layer owner{protocol::Plane::owner, {}, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const auto x = static_cast<float>(i);
    state->picture.pixels.push_back({value + x, value - x, value * x});
    owner.numbers.push_back(i % 7 == 0 ? kNoNumber : i % 7);
  }
  state->layers.push_back(owner);
  return state;
}

std::shared_ptr<PictureState> black() {
  auto state = std::make_shared<PictureState>();
  state->picture = {kWidth, kHeight, std::vector<std::array<float, 3>>(std::size_t{kWidth} * kHeight)};
  state->layers.push_back({protocol::Plane::owner, {}, std::vector<std::uint32_t>(std::size_t{kWidth} * kHeight)});
  return state;
}

ViewerAddress at(std::uint16_t port) {
  return {"127.0.0.1", port};
}

/// Waits for a condition that the test waits for in vain only where the product is wrong; ctest ends it then.
template <class Condition>
void wait_until(Condition condition) {
  while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

void expect_shows(const ViewerReader& viewer, const PictureState& state) {
  EXPECT_EQ(viewer.fault(), "");
  const ViewedPicture picture = viewer.pictures()["room"];
  ASSERT_EQ(picture.width, static_cast<std::int32_t>(state.picture.width));
  ASSERT_EQ(picture.height, static_cast<std::int32_t>(state.picture.height));
  ASSERT_EQ(picture.channels.size(), 4U);
  for (std::size_t i = 0; i < state.picture.pixels.size(); ++i) {
    ASSERT_EQ(picture.channels.at("R")[i], state.picture.pixels[i][0]) << i;
    ASSERT_EQ(picture.channels.at("G")[i], state.picture.pixels[i][1]) << i;
    ASSERT_EQ(picture.channels.at("B")[i], state.picture.pixels[i][2]) << i;
    const std::uint32_t owner = state.layers[0].numbers[i];
    ASSERT_EQ(picture.channels.at("owner.id")[i], owner == kNoNumber ? -1.0F : static_cast<float>(owner)) << i;
  }
}

TEST(ViewerMessages, AreThoseOfTheProtocol) {
  const std::vector<std::byte> create = create_image_message("a", 2, 3, {"R", "Z"});
  const std::string expected(
      "\x18\0\0\0\x04\x01"
      "a\0\2\0\0\0\3\0\0\0\2\0\0\0R\0Z\0",
      24);
  ASSERT_EQ(create.size(), expected.size());
  EXPECT_EQ(std::memcmp(create.data(), expected.data(), expected.size()), 0);
  const std::vector<float> plane{0, 1, 2, 3, 4, 5};
  const std::vector<std::byte> update = update_image_message("a", "Z", {1, 1, 1, 2}, plane, 2);
  const std::string head("\x22\0\0\0\x03\0a\0Z\0\1\0\0\0\1\0\0\0\1\0\0\0\2\0\0\0", 26);
  ASSERT_EQ(update.size(), head.size() + 8);
  EXPECT_EQ(std::memcmp(update.data(), head.data(), head.size()), 0);
  const std::array<float, 2> values{3, 5};
  EXPECT_EQ(std::memcmp(update.data() + head.size(), values.data(), sizeof values), 0);
}

TEST(ViewerAddresses, AreReadInAllForms) {
  EXPECT_EQ(parse_viewer_address("localhost").port, kViewerPort);
  EXPECT_EQ(parse_viewer_address("box:99").host, "box");
  EXPECT_EQ(parse_viewer_address("box:99").port, 99);
  EXPECT_EQ(parse_viewer_address("[::1]:99").host, "::1");
  EXPECT_EQ(parse_viewer_address("[::1]").host, "::1");
  for (const char* wrong : {"", ":99", "box:", "box:0", "box:65536", "box:x", "::1", "::1:99"})
    EXPECT_THROW(parse_viewer_address(wrong), UsageError) << wrong;
  EXPECT_THROW(ViewerConnection({"there.is.no.such.host.invalid", 1}), InputError);
}

TEST(PictureSender, ShowsTheWholePictureAndSendsWhatHasChanged) {
  const ViewerReader viewer;
  PictureSender sender(at(viewer.port()), "room", black());
  const auto first = state_of(1);
  sender.put(first);
  wait_until([&] { return viewer.pictures()["room"].updates == 6 * 4; });
  expect_shows(viewer, *first);
  auto last = std::make_shared<PictureState>(*first);
  last->picture.pixels[299][1] = 7;  // in one tile, of one channel
  EXPECT_TRUE(sender.finish(last));
  viewer.wait_for_end();
  expect_shows(viewer, *last);
  EXPECT_EQ(viewer.pictures()["room"].updates, 6 * 4 + 1);
  EXPECT_EQ(viewer.pictures()["room"].created, 1);
}

TEST(PictureSender, AViewerMayComeLateAndGoAndComeAgain) {
  std::uint16_t port = 0;
  {
    const ViewerReader nobody;  // a port that is free
    port = nobody.port();
  }
  PictureSender sender(at(port), "room", black());
  const auto first = state_of(1), second = state_of(2);
  sender.put(first);
  std::this_thread::sleep_for(std::chrono::milliseconds(400));  // it tries in vain
  {
    const ViewerReader late(port);
    wait_until([&] { return late.pictures()["room"].updates == 6 * 4; });
    expect_shows(late, *first);
  }
  const ViewerReader again(port);
  wait_until([&] { return again.pictures()["room"].updates == 6 * 4; });
  expect_shows(again, *first);
  EXPECT_TRUE(sender.finish(second));
  again.wait_for_end();
  expect_shows(again, *second);
}

TEST(PictureSender, NobodyIsWaitedFor) {
  const ViewerReader deaf(0, ViewerReader::Manner::never_reads);
  PictureSender sender(at(deaf.port()), "room", state_of(0, 1024, 1024));
  wait_until([&] { return deaf.connections() == 1; });
  for (int i = 1; i < 20; ++i) sender.put(state_of(static_cast<float>(i), 1024, 1024));
  EXPECT_FALSE(sender.finish(state_of(20, 1024, 1024)));
  std::uint16_t port = 0;
  {
    const ViewerReader nobody;
    port = nobody.port();
  }
  PictureSender alone(at(port), "room", black());
  EXPECT_FALSE(alone.finish(state_of(1)));
}

}  // namespace
}  // namespace torolux
