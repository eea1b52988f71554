// SPDX-License-Identifier: MIT
// Proves: an .exr comes back bit for bit and is the same every time; damaged ones are refused and never crash.
#include <gmock/gmock.h>

#include <limits>

#include "emulator/errors.hpp"
#include "host_tools/picture/formats.hpp"
#include "tests/unit/host_tools/picture/sample_picture.hpp"

namespace torolux {
namespace {

using testing_support::sample_picture;

TEST(Exr, ComesBackBitForBit) {
  const Picture picture = sample_picture(37, 21);
  const Picture back = decode_exr(encode_exr(picture), "test");
  EXPECT_EQ(back.width, 37U);
  EXPECT_EQ(back.height, 21U);
  EXPECT_EQ(back.pixels, picture.pixels);
}

TEST(Exr, IsTheSameEveryTime) {
  const Picture picture = sample_picture(64, 64);
  EXPECT_EQ(encode_exr(picture), encode_exr(picture));
}

TEST(Exr, EveryTruncationIsRefused) {
  const std::vector<std::byte> whole = encode_exr(sample_picture(5, 4));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(decode_exr(std::span(whole.data(), size), "cut.exr"), InputError) << size << " bytes";
}

// Each byte in turn is changed: the reader gives a picture or refuses; it must not crash, hang or ask for gigabytes.
TEST(Exr, DamagedFilesNeverCrash) {
  const std::vector<std::byte> whole = encode_exr(sample_picture(5, 4));
  int refused = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const std::byte flip : {std::byte{0x01}, std::byte{0x80}, std::byte{0xFF}}) {
      std::vector<std::byte> damaged = whole;
      damaged[i] ^= flip;
      try {
        decode_exr(damaged, "damaged.exr");
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(Exr, SomethingElseIsRefusedByName) {
  const std::string message = testing_support::message_of<InputError>(
      [] { decode_exr(testing_support::bytes_of("PF\n1 1\n-1.0\nxxxxxxxxxxxx"), "other.exr"); });
  EXPECT_THAT(message, testing::HasSubstr("other.exr"));
}

}  // namespace
}  // namespace torolux
