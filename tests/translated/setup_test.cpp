// SPDX-License-Identifier: MIT
// What an engine is set up with: a first translation that the user ends, and more threads than there are PEs.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "emulator/engines/translated/compile/cache.hpp"
#include "emulator/engines/translated/run/translated_engine.hpp"
#include "emulator/errors.hpp"
#include "tests/translated/runs.hpp"
#include "tests/unit/emulator/engines/engine_support.hpp"

namespace torolux::test {
namespace {

using translated::TemporaryFolder;
using translated::TranslationOptions;

Image halting() {
  Code code;
  code << hint(protocol::Hint::halt);
  return image_of(code);
}

TEST(EngineSetup, AFirstTranslationThatIsInterruptedEndsAndLeavesNothing) {
  const TemporaryFolder cache;
  TranslationOptions options;
  options.cache_folder = cache.path();
  int asked = 0;
  const auto interrupted = [&](EngineSetup setup) {
    setup.interrupted = [&asked] { return ++asked > 0; };
    return make_translated_engine(setup, options);
  };
  EXPECT_THROW(BarePes(halting(), 1, {}, interrupted), MachineFailure);
  EXPECT_GT(asked, 0);
  EXPECT_TRUE(std::filesystem::is_empty(cache.path()));
  // Nobody is asked where there is nothing to wait for.
  const auto patient = [&](const EngineSetup& setup) { return make_translated_engine(setup, options); };
  EXPECT_NO_THROW(BarePes(halting(), 1, {}, patient));
  asked = 0;
  EXPECT_NO_THROW(BarePes(halting(), 1, {}, interrupted));
  EXPECT_EQ(asked, 0);
}

std::ptrdiff_t threads_of_this_process() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
}

// The scheduler's own thread, and one for each PE: others would only look for work.
TEST(EngineSetup, NoMoreThreadsAreStartedThanThereArePes) {
  TranslationOptions options;
  options.interpret = true;
  for (const unsigned threads : {64U, 4U, 2U}) {
    BarePes pes(halting(), 3, {}, [&](EngineSetup setup) {
      setup.threads = threads;
      return make_translated_engine(setup, options);
    });
    const std::ptrdiff_t before = threads_of_this_process();
    pes.engine().start();
    EXPECT_EQ(threads_of_this_process() - before, std::min<std::ptrdiff_t>(threads, 4) - 1) << threads;
    pes.engine().stop();
  }
}

}  // namespace
}  // namespace torolux::test
