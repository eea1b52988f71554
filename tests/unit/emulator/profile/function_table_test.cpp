// SPDX-License-Identifier: MIT
// Which function an address belongs to, by all kinds of symbols.
#include "emulator/profile/function_table.hpp"

#include <gtest/gtest.h>

namespace torolux::profile {
namespace {

constexpr std::uint32_t kCode = 0x8000'0000U;

Image image_with(std::vector<ImageSymbol> symbols) {
  Image image;
  image.segments = {{kCode, 0x100, {}, true, false}, {kCode + 0x1000, 0x1000, {}, false, true}};
  image.symbols = std::move(symbols);
  return image;
}

std::string name_at(const FunctionTable& table, std::uint32_t offset) {
  return table.name(table.range_at(kCode + offset).function);
}

TEST(FunctionTable, KnowsFunctionsBySize) {
  const FunctionTable table(image_with(
      {{kCode + 0x10, 0x10, "first", true}, {kCode + 0x20, 8, "f", true}, {kCode + 0x30, 8, "_Z6secondi", true}}));
  EXPECT_EQ(name_at(table, 0x10), "first");
  EXPECT_EQ(name_at(table, 0x1E), "first");
  EXPECT_EQ(name_at(table, 0x20), "f") << "not the type of C++ that is called so";
  EXPECT_EQ(name_at(table, 0x30), "second(int)");
  EXPECT_EQ(name_at(table, 0x28), "[no symbol]") << "behind a function";
  EXPECT_EQ(name_at(table, 0), "[no symbol]") << "before the first";
  EXPECT_TRUE(table.begins_at(kCode + 0x10));
  EXPECT_FALSE(table.begins_at(kCode + 0x12));
  EXPECT_EQ(table.range_at(kCode + 0x14).begin, kCode + 0x10);
  EXPECT_EQ(table.range_at(kCode + 0x14).bytes, 0x10U);
}

TEST(FunctionTable, TakesALabelForAFunctionWhereNoOtherIs) {
  const FunctionTable table(image_with({{kCode, 0, "_start", false},
                                        {kCode + 8, 0, "again", false},
                                        {kCode + 0x10, 0x10, "sized", true},
                                        {kCode + 0x14, 0, "inside", false}}));
  EXPECT_EQ(name_at(table, 6), "_start");
  EXPECT_EQ(name_at(table, 8), "again");
  EXPECT_EQ(name_at(table, 0xE), "again");
  EXPECT_EQ(name_at(table, 0x16), "sized") << "a label inside a function is none";
  EXPECT_FALSE(table.begins_at(kCode + 0x14));
}

TEST(FunctionTable, GivesWhatIsColdToItsFunction) {
  const FunctionTable table(image_with({{kCode, 0x10, "_Z4workv", true},
                                        {kCode + 0x20, 8, "_Z4workv.cold", true},
                                        {kCode + 0x30, 8, "_Z4workv.part.0", true}}));
  EXPECT_EQ(table.range_at(kCode + 0x20).function, table.range_at(kCode).function);
  EXPECT_NE(table.range_at(kCode + 0x30).function, table.range_at(kCode).function) << "is called on its own";
}

TEST(FunctionTable, LetsTheLaterOfTwoOverlappingFunctionsHaveItsPart) {
  const FunctionTable table(
      image_with({{kCode, 0x20, "__riscv_restore_4", true}, {kCode + 8, 0x18, "__riscv_restore_0", true}}));
  EXPECT_EQ(name_at(table, 4), "__riscv_restore_4");
  EXPECT_EQ(name_at(table, 8), "__riscv_restore_0");
  EXPECT_TRUE(table.restores(table.range_at(kCode + 8).function));
}

TEST(FunctionTable, HoldsForAnyAddressAndAnySymbols) {
  const FunctionTable none(image_with({}));
  for (const std::uint32_t address : {0U, kCode - 2, kCode, kCode + 0x100, kCode + 0x1000, 0xFFFF'FFFEU})
    EXPECT_EQ(none.range_at(address).function, kUnnamed);
  EXPECT_EQ(none.range_at(kCode + 0x100).bytes, 0U);
  const FunctionTable odd(image_with({{kCode - 0x10, 0x20, "before", true},
                                      {kCode + 0xFE, 0xFFFF'FFFFU, "long", true},
                                      {kCode + 0x2000, 8, "elsewhere", true},
                                      {kCode + 0x2010, 0, "label", false}}));
  EXPECT_EQ(name_at(odd, 0xFE), "long");
  EXPECT_EQ(odd.range_at(kCode + 0xFE).bytes, 2U);
  EXPECT_EQ(odd.range_at(kCode + 0x2000).function, kUnnamed) << "no code is there";
}

}  // namespace
}  // namespace torolux::profile
