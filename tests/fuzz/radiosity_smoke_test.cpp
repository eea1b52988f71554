// SPDX-License-Identifier: MIT
// A valid radiosity file, cut and changed at random (a fixed seed) ten thousand times, and noise: nothing crashes, each
// refusal names the file. Length and CRC-32 are set right, so that what lies behind them is met.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/fuzz/load_radiosity.hpp"

namespace torolux {
namespace {

class Changes {
 public:
  explicit Changes(std::vector<std::byte> valid) : valid_(std::move(valid)) {}

  std::vector<std::byte> next() {
    std::vector<std::byte> bytes = valid_;
    if (random_() % 16 == 0) {  // noise of any length
      bytes.resize(random_() % (2 * valid_.size()));
      for (std::byte& byte : bytes) byte = any_byte();
      return bytes;
    }
    for (std::size_t changes = 1 + random_() % 3; changes > 0; --changes) change(bytes);
    return bytes;
  }

 private:
  std::byte any_byte() { return static_cast<std::byte>(random_()); }

  void change(std::vector<std::byte>& bytes) {
    if (bytes.empty()) return;
    const std::size_t at = random_() % bytes.size();
    switch (random_() % 8) {
      case 0:
        bytes.resize(at);
        break;
      case 1:
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), random_() % 100, any_byte());
        break;
      case 2:
        bytes[at] = any_byte();
        break;
      default:
        put_number(bytes, at & ~std::size_t{7});
        break;
    }
  }

  /// Most of the file is signed 64-bit numbers: put odd ones there.
  void put_number(std::vector<std::byte>& bytes, std::size_t at) {
    static constexpr std::array<std::int64_t, 8> kOdd{
        0, 1, -1, INT64_MAX, INT64_MIN, std::int64_t{1} << 57U, (std::int64_t{1} << 57U) + 1, std::int64_t{1} << 32U};
    const std::int64_t number = kOdd[random_() % kOdd.size()];
    if (at + sizeof number <= bytes.size()) std::memcpy(bytes.data() + at, &number, sizeof number);
  }

  std::vector<std::byte> valid_;
  std::mt19937 random_{57};
};

TEST(FuzzSmoke, Radiosity) {
  const RadiosityFuzz fuzz;
  const std::vector<std::byte> valid = fuzz.valid_file();
  ASSERT_TRUE(fuzz.read(valid));
  ASSERT_LT(valid.size(), 8192U);
  Changes changes(valid);
  int taken = 0;
  constexpr int kCount = 10'000;
  for (int i = 0; i < kCount; ++i) taken += fuzz.read(changes.next()) ? 1 : 0;
  // Zeros put where zeros stood leave a good file: some must live and most must be refused, or it would prove nothing.
  EXPECT_GT(taken, kCount / 100);
  EXPECT_LT(taken, kCount / 2);
}

}  // namespace
}  // namespace torolux
