// SPDX-License-Identifier: MIT
// Proves: the progress line says what is asked of it, fits on a terminal, is silent where it is not wanted, and is
// wiped.
#include "host_tools/report/progress_line.hpp"

#include <gmock/gmock.h>

#include <sstream>

namespace torolux {
namespace {

using testing::HasSubstr;

constexpr RenderProgress kProgress{RenderStage::radiosity, 0.5, 0.0321, 3900, 4096, 1'234'500};

TEST(Progress, TellsStageUnshotHomeVirtualTimeAndTimeLeft) {
  EXPECT_EQ(progress_text(kProgress, 100e6, 42),
            "radiosity    50 %  unshot 3.21 %  home 3900/4096  virtual 12.3 ms  left 42 s");
}

TEST(Progress, UnshotBelongsToTheRadiosityStage) {
  RenderProgress progress = kProgress;
  progress.stage = RenderStage::ray_tracing;
  EXPECT_EQ(progress_text(progress, 100e6, -1), "ray tracing  50 %  home 3900/4096  virtual 12.3 ms");
}

TEST(Progress, FitsOnALine) {
  const RenderProgress huge{RenderStage::radiosity, 7, 1, ~0ULL, ~0ULL, ~0ULL};
  EXPECT_LE(progress_text(huge, 1, 1e8).size(), 79U);
}

TEST(ProgressLine, ShowsAndWipes) {
  std::ostringstream out;
  {
    ProgressLine line(out, true, 100e6);
    line.show(kProgress);
    line.show(kProgress);  // too soon: left out
  }
  EXPECT_THAT(out.str(), testing::StartsWith("\r\x1b[Kradiosity"));
  EXPECT_THAT(out.str(), testing::EndsWith("ms\r\x1b[K"));
  EXPECT_EQ(out.str().find("radiosity"), out.str().rfind("radiosity"));
}

TEST(ProgressLine, IsSilentWithoutATerminal) {
  std::ostringstream out;
  {
    ProgressLine line(out, false, 100e6);
    line.show(kProgress);
  }
  EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace torolux
