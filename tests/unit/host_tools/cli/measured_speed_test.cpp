// SPDX-License-Identifier: MIT
// Proves: what a render took on this computer is what the next one is foretold by, for each engine; where there is no
// cache, or nothing to be learnt, nothing is kept.
#include "host_tools/cli/measured_speed.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "host_tools/render/predict.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux {
namespace {

class MeasuredSpeed : public testing::Test {
 protected:
  MeasuredSpeed() {
    machine_.engine = "translated";
    machine_.threads = 1;
    figures_.machine.pes.resize(2);
    figures_.machine.pes[0].instructions = 40'000'000'000;
    figures_.machine.pes[1].packets_sent = 1'000'000;
    set_cache(folder_.path().string());
  }
  ~MeasuredSpeed() override { unsetenv("XDG_CACHE_HOME"); }  // NOLINT(concurrency-mt-unsafe)
  static void set_cache(const std::string& folder) {
    setenv("XDG_CACHE_HOME", folder.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  }
  double foretold() const { return wall_seconds_of(40e9, 1e6, machine_, 2); }

  testing_support::TemporaryFolder folder_;
  MachineChoice machine_;
  RenderFigures figures_;
};

TEST_F(MeasuredSpeed, IsThatOfTheLastRender) {
  EXPECT_EQ(measured_slowness("translated"), std::nullopt);
  for (const double times : {3.0, 0.5}) {
    figures_.run_seconds = times * foretold();
    remember_speed(machine_, figures_);
    ASSERT_TRUE(measured_slowness("translated"));
    EXPECT_NEAR(*measured_slowness("translated"), times, 1e-5);
  }
  EXPECT_EQ(measured_slowness("qemu"), std::nullopt);
}

TEST_F(MeasuredSpeed, IsNotTakenFromWhatTellsNothing) {
  figures_.run_seconds = 1.9;
  remember_speed(machine_, figures_);
  figures_.run_seconds = 30;
  machine_.debugging.qemu_pes = {1};
  remember_speed(machine_, figures_);
  EXPECT_EQ(folder_.files(), 0U);
}

TEST_F(MeasuredSpeed, DoesWithoutACacheAndWithADamagedOne) {
  figures_.run_seconds = 30;
  set_cache("/dev/null");
  remember_speed(machine_, figures_);
  EXPECT_EQ(measured_slowness("translated"), std::nullopt);
  set_cache(folder_.path().string());
  std::filesystem::create_directory(folder_.path() / "torolux");
  for (const char* text : {"", "fast", "0", "-1", "1e9", "nan"}) {
    std::ofstream(folder_.path() / "torolux" / "slowness-translated") << text;
    EXPECT_EQ(measured_slowness("translated"), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace torolux
