// SPDX-License-Identifier: MIT
// The default machine file, cut and changed at random (a fixed seed): nothing crashes, each refusal says where. The
// same is done to images in tests/unit/emulator/engines/image/image_test.cpp.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "tests/fuzz/load_machine.hpp"

namespace torolux {
namespace {

TEST(FuzzSmoke, MachineToml) {
  std::ifstream stream(std::string(TOROLUX_SOURCE_DIR) + "/emulator/description/default.toml");
  const std::string whole((std::istreambuf_iterator<char>(stream)), {});
  ASSERT_TRUE(load_machine_toml(whole));
  const char* const odd[] = {"nan", "-1", "1e999", "99999999999999999999", "\"", "[", "]", "\n", "=", ".", "{", "\xff"};
  std::mt19937 random(7);
  int loaded = 0;
  constexpr int kCount = 10'000;
  for (int i = 0; i < kCount; ++i) {
    std::string text = whole;
    const std::size_t at = random() % text.size();
    switch (random() % 4) {
      case 0:
        text.resize(at);
        break;
      case 1:
        text[at] = static_cast<char>(random());
        break;
      case 2:
        text.erase(at, random() % 12);
        break;
      default:
        text.insert(at, odd[random() % std::size(odd)]);
        break;
    }
    loaded += load_machine_toml(text) ? 1 : 0;
  }
  // Most of the file is comments, so many changes do no harm; of the rest most are refused.
  EXPECT_GT(loaded, kCount / 10);
  EXPECT_LT(loaded, kCount * 9 / 10);
}

}  // namespace
}  // namespace torolux
