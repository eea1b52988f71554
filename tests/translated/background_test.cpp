// SPDX-License-Identifier: MIT
// Translation in the background: a program begins interpreted and goes on translated, with the same registers, cycles
// and instructions; and it need not be waited for.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <vector>

#include "emulator/description/description.hpp"
#include "emulator/engines/translated/compile/cache.hpp"
#include "emulator/engines/translated/run/translated_image.hpp"
#include "tests/translated/runs.hpp"

namespace torolux::test {
namespace {

using translated::TemporaryFolder;
using translated::TranslatedImage;
using translated::TranslatedPe;
using translated::TranslationOptions;

constexpr Reg kCount = 6, kEnd = 7;
constexpr std::uint32_t kTurns = 0x100'0000;

/// Counts to kTurns.
Image counting() {
  Code code;
  code << lui(kEnd, kTurns) << addi(kCount, kCount, 1) << bne(kCount, kEnd, -4) << hint(protocol::Hint::halt);
  return image_of(code);
}

TranslationOptions in_background(const std::filesystem::path& cache) {
  TranslationOptions options;
  options.cache_folder = cache;
  options.in_background = true;
  return options;
}

struct Pe {
  explicit Pe(const TranslatedImage& code, const Image& image) : memory(protocol::kSmallestLocalMemory) {
    image.load_into(memory);
    code.start(state, memory, memory.size());
  }
  std::vector<std::byte> memory;
  TranslatedPe state{};
};

TEST(TranslationInBackground, GoesOnWhereTheInterpreterStands) {
  const TemporaryFolder cache;
  const Image image = counting();
  const LatencyTable latency = MachineDescription().processor.latency;
  const TranslatedImage code(image, latency, in_background(cache.path()));
  ASSERT_FALSE(code.from_cache());
  Pe pe(code, image);
  pe.state.cycle_limit = 10'000;
  EXPECT_EQ(code.run(pe.state), TranslatedImage::Stop::cycle_limit);
  const std::uint32_t interpreted = pe.state.x[kCount];
  while (!code.is_translated()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  pe.state.cycle_limit = ~std::uint64_t{0};
  EXPECT_EQ(code.run(pe.state), TranslatedImage::Stop::hint);
  EXPECT_GT(interpreted, 0U);
  EXPECT_LT(interpreted, kTurns);
  EXPECT_EQ(pe.state.x[kCount], kTurns);

  TranslationOptions interpret;
  interpret.interpret = true;
  const TranslatedImage plain(image, latency, interpret);
  Pe whole(plain, image);
  EXPECT_EQ(plain.run(whole.state), TranslatedImage::Stop::hint);
  EXPECT_EQ(pe.state.cycles, whole.state.cycles);
  EXPECT_EQ(pe.state.instructions, whole.state.instructions);
  EXPECT_EQ(pe.state.pc, whole.state.pc);
  EXPECT_TRUE(TranslatedImage(image, latency, in_background(cache.path())).from_cache());
}

// What was to be compiled for hours ends with the program, and leaves nothing in the cache.
TEST(TranslationInBackground, EndsWithWhoWantedIt) {
  const TemporaryFolder cache;
  { const TranslatedImage code(counting(), {1, 2, 3}, in_background(cache.path())); }
  EXPECT_TRUE(std::filesystem::is_empty(cache.path()));
}

TEST(TranslationInBackground, WithoutACompilerAllIsInterpreted) {
  const char* const path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): the test's only thread
  ASSERT_NE(path, nullptr);
  const std::string before = path;
  const TemporaryFolder nothing;
  setenv("PATH", nothing.path().c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  const Image image = counting();
  testing::internal::CaptureStderr();
  const TranslatedImage code(image, {1, 2, 3}, in_background(nothing.path()));
  setenv("PATH", before.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_NE(testing::internal::GetCapturedStderr().find("interpreted"), std::string::npos);
  Pe pe(code, image);
  EXPECT_EQ(code.run(pe.state), TranslatedImage::Stop::hint);
  EXPECT_FALSE(code.is_translated());
  EXPECT_EQ(pe.state.x[kCount], kTurns);
}

}  // namespace
}  // namespace torolux::test
