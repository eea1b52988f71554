// SPDX-License-Identifier: MIT
// Proves: a page gets the newest of each message, all of it when it comes late, nothing twice, and never much at once.
#include "host_tools/display/live_state.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <thread>
#include <vector>

namespace torolux {
namespace {

using namespace std::chrono_literals;
using Pixel = LivePicture::Pixel;

struct Told {
  MessageType type;
  std::string contents;
};

std::vector<Told> messages_in(const std::string& bytes) {
  std::vector<Told> told;
  std::size_t at = 0;
  while (at < bytes.size()) {
    MessageHeader header{};
    std::memcpy(&header, &bytes.at(at), sizeof header);
    told.push_back({static_cast<MessageType>(header.type), bytes.substr(at + sizeof header, header.bytes)});
    at += sizeof header + header.bytes;
  }
  EXPECT_EQ(at, bytes.size());
  return told;
}

std::vector<Told> news(LiveState& state, Seen& seen) {
  std::string out;
  state.take_news(seen, out, 0ms);
  return messages_in(out);
}

TEST(LiveState, ReplacesWhatNobodyHasTaken) {
  LiveState state;
  Seen seen;
  for (const char* text : {"1", "2", "3"}) state.update().put(MessageType::progress, text);
  state.update().put(MessageType::machine, "m");
  const auto told = news(state, seen);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].type, MessageType::machine);
  EXPECT_EQ(told[1].contents, "3");
  EXPECT_TRUE(news(state, seen).empty());
  Seen late;
  EXPECT_EQ(news(state, late).size(), 2U);
}

TEST(LiveState, WaitsForNews) {
  LiveState state;
  Seen seen;
  std::string out;
  state.take_news(seen, out, 1ms);
  EXPECT_TRUE(out.empty());
  std::thread later([&] { state.update().put(MessageType::texts, "t"); });
  state.take_news(seen, out, 10s);
  later.join();
  EXPECT_EQ(messages_in(out).size(), 1U);
}

TEST(LiveState, NobodyWaitsForAPageThatCopies) {
  LiveState state;
  auto copying = state.update();
  bool tried = true;
  std::thread([&] { tried = state.try_update().has_value(); }).join();
  EXPECT_FALSE(tried);
}

/// A page's picture, made of what it is told.
struct Page {
  Seen seen;
  std::vector<Pixel> pixels;
  std::size_t pictures = 0, bytes = 0, most_bytes = 0;

  /// False: there was nothing new.
  bool look(LiveState& state) {
    std::string out;
    state.take_news(seen, out, 0ms);
    bytes += out.size();
    most_bytes = std::max(most_bytes, out.size());
    for (const Told& told : messages_in(out)) {
      if (told.type == MessageType::picture) {
        ++pictures;
        pixels.assign(std::stoul(told.contents), Pixel{});
      } else if (told.type == MessageType::pixels) {
        PixelsHeader header{};
        std::memcpy(&header, told.contents.data(), sizeof header);
        EXPECT_EQ(told.contents.size(), sizeof header + header.count * sizeof(Pixel));
        EXPECT_LE(header.first + header.count, pixels.size());
        std::memcpy(&pixels.at(header.first), told.contents.data() + sizeof header, header.count * sizeof(Pixel));
      }
    }
    return !out.empty();
  }
};

std::vector<Pixel> counted(std::size_t first, std::size_t count, float add) {
  std::vector<Pixel> pixels;
  for (std::size_t i = 0; i < count; ++i) pixels.push_back({static_cast<float>(first + i) + add, 0, 1});
  return pixels;
}

TEST(LivePicture, TellsWhatHasChanged) {
  LiveState state;
  constexpr std::size_t kPixels = 150;  // two runs, and a part of one
  state.update().begin_picture(kPixels, 1, std::to_string(kPixels));
  Page early;
  early.look(state);
  EXPECT_EQ(early.pictures, 1U);
  state.update().put_pixels(64, counted(64, 64, 0));
  early.look(state);
  EXPECT_EQ(early.pixels[63], Pixel{});
  EXPECT_EQ(early.pixels[64][0], 64);
  EXPECT_EQ(early.pixels[128], Pixel{});
  const std::size_t before = early.bytes;
  state.update().put_pixels(128, counted(128, 22, 0.5F));
  early.look(state);
  EXPECT_EQ(early.bytes - before, sizeof(MessageHeader) + sizeof(PixelsHeader) + 22 * sizeof(Pixel));
  Page late;
  late.look(state);
  EXPECT_EQ(late.pixels, early.pixels);
  state.update().begin_picture(10, 1, "10");
  early.look(state);
  EXPECT_EQ(early.pixels, std::vector<Pixel>(10));
}

TEST(LivePicture, ComesInParts) {
  LiveState state;
  constexpr std::size_t kPixels = 3 * LivePicture::kMostPixelsAtOnce + 7;
  state.update().begin_picture(kPixels, 1, std::to_string(kPixels));
  const std::vector<Pixel> pixels = counted(0, kPixels, 0);
  state.update().put_pixels(0, pixels);
  Page page;
  int looks = 0;
  while (page.look(state)) ++looks;
  EXPECT_EQ(looks, 4);
  EXPECT_EQ(page.pixels, pixels);
  EXPECT_LE(page.most_bytes, LivePicture::kMostPixelsAtOnce * sizeof(Pixel) + 100);
}

}  // namespace
}  // namespace torolux
