// SPDX-License-Identifier: MIT
// Proves of `--follow`: a pixel's additions are its value in the picture; every leg of the way that is sent is
// received; light that is followed ends in a deposit or nowhere; and following changes nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "emulator/errors.hpp"
#include "host_tools/trace/story.hpp"
#include "tests/physics/same_picture.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;

/// Every face between PEs is a hand-over, so that there is a story.
RenderCase handed_over() {
  RenderCase cornell = small_cornell("cornell_spheres");
  take_scheme(cornell.machine, Scheme::paper);
  cornell.quality.samples = 1;
  cornell.machine.columns = cornell.machine.rows = 4;
  cornell.machine.subspaces = {14, 14, 14};
  return cornell;
}

RenderResult follow(Story& story, RenderCase cornell) {
  cornell.machine.follower = &story;
  return run_case(cornell);
}

std::size_t lines_with(const Story& story, const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      story.lines(), [&](const std::string& line) { return line.find(text) != std::string::npos; }));
}

/// The three numbers behind `text` in a line.
std::array<double, 3> numbers_behind(const std::string& line, const std::string& text) {
  std::istringstream stream(line.substr(line.find(text) + text.size()));
  std::array<double, 3> v{};
  char mark = 0;
  stream >> mark >> v[0] >> mark >> v[1] >> mark >> v[2];
  EXPECT_TRUE(stream) << line;
  return v;
}

TEST(Story, OfAPixelIsItsValueInThePicture) {
  const RenderCase cornell = handed_over();
  const std::uint32_t width = cornell.quality.width;
  std::size_t handed_over_in_all = 0;
  for (const auto& [column, row] : {std::pair(width / 2, width / 2), {width / 3, 2 * width / 3}, {width / 4, 1U}}) {
    Story story(FollowedPixel{column, row, 0});
    const RenderResult result = follow(story, cornell);
    const auto sum = numbers_behind(story.lines().back().find("has got") != std::string::npos
                                        ? story.lines().back()
                                        : story.lines().at(story.lines().size() - 2),
                                    "has got ");
    for (std::size_t c = 0; c < 3; ++c) {
      const double shown = result.picture.pixels[row * width + column][c];
      EXPECT_NEAR(sum[c], shown, 1e-4 * shown + 1e-12) << "five digits are told";
    }
    EXPECT_EQ(lines_with(story, "; sent to"), lines_with(story, "received after"));
    handed_over_in_all += lines_with(story, "; sent to");
  }
  EXPECT_GT(handed_over_in_all, 3U);
}

TEST(Story, OfLightEndsWhereItFalls) {
  std::size_t deposits = 0;
  for (const std::uint32_t direction : {5U, 21U, 60U, 101U, 150U}) {
    Story story(FollowedShot{0, 0, direction});
    follow(story, handed_over());
    ASSERT_FALSE(story.lines().empty());
    EXPECT_THAT(story.lines().front(), HasSubstr("shot 0: patch "));
    EXPECT_THAT(story.lines().front(), HasSubstr(", emits "));
    EXPECT_EQ(lines_with(story, "; sent to"), lines_with(story, "received after"));
    EXPECT_LE(lines_with(story, "a deposit of"), 1U);
    deposits += lines_with(story, "a deposit of");
  }
  EXPECT_GT(deposits, 0U);
}

// Of a shot's first points some go to other PEs, which make their records.
TEST(Story, OfAPointThatTravels) {
  std::size_t travelled = 0;
  for (std::uint32_t point = 0; point < 4; ++point) {
    Story story(FollowedShot{0, point, 0});
    follow(story, small_cornell("cornell_spheres"));
    travelled += lines_with(story, "point " + std::to_string(point) + " of the shot");
    EXPECT_EQ(lines_with(story, "; sent to"), lines_with(story, "received after"));
  }
  EXPECT_GT(travelled, 0U);
}

TEST(Story, ChangesNothing) {
  Story story(FollowedPixel{1, 1, 0});
  const RenderResult with = follow(story, handed_over());
  const RenderResult without = run_case(handed_over());
  EXPECT_EQ(bytes_of(with.picture), bytes_of(without.picture));
  EXPECT_EQ(exact_figures(with.figures), exact_figures(without.figures));
}

TEST(Story, OfWhatIsNotThereIsRefused) {
  const RenderCase cornell = handed_over();
  Story beside(FollowedPixel{cornell.quality.width, 0, 0});
  EXPECT_THROW(follow(beside, cornell), InputError);
  Story sample(FollowedPixel{0, 0, 1});
  EXPECT_THROW(follow(sample, cornell), InputError);
  Story direction(FollowedShot{0, 0, 1'000'000});
  EXPECT_THROW(follow(direction, cornell), InputError);
  Story late(FollowedShot{1'000'000, 0, 0});
  follow(late, cornell);
  EXPECT_GE(lines_with(late, "there was no such shot"), 1U);
}

}  // namespace
}  // namespace torolux::test
