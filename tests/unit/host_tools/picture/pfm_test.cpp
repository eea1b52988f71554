// SPDX-License-Identifier: MIT
// Proves: a .pfm is what the format says, comes back bit for bit, and damaged ones are refused.
#include <gmock/gmock.h>

#include <bit>

#include "emulator/errors.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/picture/formats.hpp"
#include "tests/unit/host_tools/picture/sample_picture.hpp"

namespace torolux {
namespace {

using testing::HasSubstr;
using testing_support::bytes_of;
using testing_support::message_of;
using testing_support::sample_picture;

TEST(Pfm, IsWrittenBottomRowFirstLittleEndian) {
  const Picture picture{1, 2, {{1.0F, 2.0F, 4.0F}, {0.5F, 0.25F, 0.0F}}};
  const std::string expected = std::string("PF\n1 2\n-1.0\n") + std::string("\0\0\0\x3F\0\0\x80\x3E\0\0\0\0", 12) +
                               std::string("\0\0\x80\x3F\0\0\0\x40\0\0\x80\x40", 12);
  EXPECT_EQ(encode_pfm(picture), bytes_of(expected));
}

TEST(Pfm, ComesBackBitForBit) {
  const Picture picture = sample_picture(7, 5);
  const Picture back = decode_pfm(encode_pfm(picture), "test");
  EXPECT_EQ(back.width, 7U);
  EXPECT_EQ(back.height, 5U);
  EXPECT_EQ(back.pixels, picture.pixels);
}

TEST(Pfm, ReadsGreyBigEndianAndScale) {
  const Picture picture =
      decode_pfm(bytes_of(std::string("Pf\n2 1\n2.0\n") + std::string("\x3F\x80\0\0\x40\0\0\0", 8)), "test");
  const std::vector<std::array<float, 3>> expected = {{2, 2, 2}, {4, 4, 4}};
  EXPECT_EQ(picture.pixels, expected);
}

TEST(Pfm, EveryTruncationIsRefused) {
  const std::vector<std::byte> whole = encode_pfm(sample_picture(3, 2));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::span<const std::byte> part(whole.data(), size);
    EXPECT_THROW(decode_pfm(part, "cut.pfm"), InputError) << size << " bytes";
  }
}

TEST(Pfm, DamagedHeadersAreRefusedByName) {
  const std::string pixels(12, '\0');
  for (const char* header :
       {"P6\n1 1\n-1.0\n", "PF\n-1 1\n-1.0\n", "PF\n1 1\n0\n", "PF\n1 1\nnan\n", "PF\n1 1\n1x\n", "PF\n1\n-1.0\n",
        "PF\n0 1\n-1\n", "PF\n1 2\n-1.0\n", "PF\n1 0x1\n-1.0\n", "PF\n99999999999999999999999 1\n-1.0\n",
        "PF\n65535 65535\n-1.0\n", "PF\n1 1\n-1.0\n1234"}) {
    const std::string message = message_of<InputError>([&] { decode_pfm(bytes_of(header + pixels), "damaged.pfm"); });
    EXPECT_THAT(message, HasSubstr("damaged.pfm")) << header;
  }
}

TEST(Pfm, IsReadFromAFile) {
  const testing_support::TemporaryFolder folder;
  const Picture picture = sample_picture(4, 3);
  write_picture(picture, folder.path() / "A.PFM");
  EXPECT_EQ(read_picture(folder.path() / "A.PFM").pixels, picture.pixels);
  EXPECT_THROW(read_picture(folder.path() / "missing.pfm"), InputError);
  EXPECT_THROW(read_picture(folder.path() / "A.png"), InputError);
  EXPECT_THROW(read_picture(folder.path()), InputError);
}

}  // namespace
}  // namespace torolux
