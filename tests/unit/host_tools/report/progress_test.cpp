// SPDX-License-Identifier: MIT
// Proves: the progress line says what is asked of it, fits on a terminal, is silent where it is not wanted, and is
// wiped.
#include "host_tools/report/progress_line.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "host_tools/render/course.hpp"
#include "host_tools/setup/setup.hpp"

namespace torolux {
namespace {

using testing::HasSubstr;

constexpr RenderProgress kProgress{RenderStage::radiosity, 0.5, 0.0321, 3900, 4096, 1'234'500, 0.25};

TEST(Progress, TellsTheWholeAndTheTimeLeftFirst) {
  EXPECT_EQ(progress_text(kProgress, 100e6, 42, 79, false),
            " 25 %  42 s left  radiosity 50 %  unshot 3.21 %  virtual 12.3 ms");
}

TEST(Progress, TellsOfCreditsWhereItIsToSayMore) {
  EXPECT_THAT(progress_text(kProgress, 100e6, 42, 99, true), testing::EndsWith("ms  credits home 3900/4096"));
}

TEST(Progress, UnshotBelongsToTheRadiosityStage) {
  RenderProgress progress = kProgress;
  progress.stage = RenderStage::ray_tracing;
  EXPECT_EQ(progress_text(progress, 100e6, -1, 79, false), " 25 %  ray tracing 50 %  virtual 12.3 ms");
}

TEST(Progress, FitsAnyWidthAndLeavesOutWhatMattersLeast) {
  const std::string whole = progress_text(kProgress, 100e6, 42, 200, true);
  for (std::size_t width = 0; width < 120; ++width) {
    const std::string text = progress_text(kProgress, 100e6, 42, width, true);
    EXPECT_LE(text.size(), width);
    EXPECT_THAT(whole, testing::StartsWith(text));
  }
  EXPECT_EQ(progress_text(kProgress, 100e6, 42, 20, true), " 25 %  42 s left");
  const RenderProgress huge{RenderStage::radiosity, 7, 1, ~0ULL, ~0ULL, ~0ULL, 7};
  EXPECT_LE(progress_text(huge, 1, 1e8, 79, true).size(), 79U);
}

Quality small_quality() {
  Quality quality;
  quality.emission_records = 1000;
  quality.width = 10;
  quality.height = 10;
  quality.samples = 10;
  return quality;
}

// Of one machine after the other: it never falls, begins at nothing and ends with all; also where the radiosity stage
// turns out to take far longer (radiosity_records).
TEST(Progress, TheWholeNeverFalls) {
  for (const auto& [refine, radiosity_records] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 1e6}, {1.0, 1e6}}) {
    for (const bool given : {false, true}) {
      Quality quality = small_quality();
      quality.refine = refine;
      Course course(quality, given);
      double last = 0;
      const auto look = [&, records = radiosity_records](RenderStage stage, double fraction) {
        RenderProgress progress{stage, fraction, 0, 0, 0, 0};
        progress.radiosity_records = records;
        const double share = course.share(progress);
        EXPECT_GE(share, last);
        EXPECT_LE(share, 1);
        last = share;
      };
      for (unsigned draft = 0; draft < (refine > 0 && !given ? kDrafts : 0); ++draft) {
        course.begin_machine();
        for (const double f : {0.0, 1.0}) look(RenderStage::load, f);
        for (const double f : {0.0, 0.5, 1.0}) look(RenderStage::radiosity, f);
        EXPECT_LT(last, 0.5);
      }
      course.begin_machine();
      look(RenderStage::load, 1);
      const double before = last;
      if (!given) {
        for (const double f : {0.0, 0.5, 1.0}) look(RenderStage::radiosity, f);
        EXPECT_GT(last, before + 0.3);
      }
      look(RenderStage::load, 0);
      for (const double f : {0.0, 0.5, 1.0}) look(RenderStage::ray_tracing, f);
      EXPECT_DOUBLE_EQ(last, 1);
    }
  }
}

TEST(ProgressLine, ShowsAndWipes) {
  std::ostringstream out;
  {
    ProgressLine line(out, true, 100e6);
    line.show(kProgress);
    line.show(kProgress);  // too soon: left out
  }
  EXPECT_THAT(out.str(), testing::StartsWith("\r\x1b[K 25 %"));
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
