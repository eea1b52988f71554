// SPDX-License-Identifier: MIT
// What a refusal for want of memory advises is followed, word by word: each way out that is named fits at once.
#include <gmock/gmock.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "host_tools/cli/prepared_render.hpp"
#include "host_tools/cli/resolve.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;

std::vector<std::string> split_words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

/// "" where it would run.
std::string refusal_of(const std::string& scene_name, std::vector<std::string> words) {
  words.insert(words.begin(), (source_dir() / "scenes" / scene_name).string());
  const RenderOptions options = parse_render_options(words);
  const Scene scene = load_scene(options.scene, scene_options(options));
  const Resolved resolved = resolve(options, scene);
  const RenderPlan planned = plan(scene, resolved.camera, resolved.quality, resolved.machine, pe_image());
  return planned.refusals.empty() ? "" : planned.refusals.front();
}

/// An option that is given again takes the place of the first.
std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& advice) {
  for (std::size_t i = 0; i + 1 < advice.size(); i += 2) {
    const auto found = std::ranges::find(words, advice[i]);
    if (found != words.end()) words.erase(found, found + 2);
  }
  words.insert(words.end(), advice.begin(), advice.end());
  return words;
}

// Before any of it is made, which would take minutes.
TEST(AdviceAtOnce, WhatNoMachineHoldsIsRefusedWithWhatMay) {
  const std::vector<std::string> small{"--pes", "1x1", "--pe-memory", "4M"};
  const auto both = [&small](const char* words) { return with(small, split_words(words)); };
  const std::string refusal = refusal_of("cornell_box", both("--elements 0.02 --patches 0.02"));
  EXPECT_THAT(refusal, HasSubstr(": use at least --elements "));
  EXPECT_THAT(refusal_of("cornell_box", both("--subspaces 1024x1024x4 --scheme paper")),
              HasSubstr("--subspaces: the map of the subspaces takes 17,825,792 bytes"));
  EXPECT_THAT(refusal_of("cornell_box", both("--patches 0.02 --pes 32x32 --pe-memory 64M")),
              HasSubstr("at most 67108864 and 8388608 are allowed"));
}

struct TooSmall {
  const char* name;
  const char* scene;
  const char* words;
  std::vector<std::string> ways;  ///< options that are to be advised, one of each way out
};

class Advice : public testing::TestWithParam<TooSmall> {};

TEST_P(Advice, FitsWhenItIsFollowed) {
  const std::vector<std::string> words = split_words(GetParam().words);
  const std::string refusal = refusal_of(GetParam().scene, words);
  const std::string before = ": it fits with ";
  const std::size_t at = refusal.find(before);
  ASSERT_NE(at, std::string::npos) << refusal;
  std::string rest = refusal.substr(at + before.size());
  for (const std::string& expected : GetParam().ways) EXPECT_THAT(rest, HasSubstr(expected));
  std::size_t ways = 0;
  while (!rest.empty()) {
    const std::size_t end = rest.find("; or ");
    const std::string advice = rest.substr(0, end);
    rest = end == std::string::npos ? "" : rest.substr(end + 5);
    EXPECT_EQ(refusal_of(GetParam().scene, with(words, split_words(advice))), "") << advice;
    ++ways;
  }
  EXPECT_EQ(ways, GetParam().ways.size());
}

// By what takes most: memory that is too small for anything but more of it; elements, on
// one PE, too; as many patches as elements; the hemi-cube's table; the map of a fine grid; the paper's copies.
INSTANTIATE_TEST_SUITE_P(
    Machines, Advice,
    testing::Values(TooSmall{"fixed", "cornell_box", "--pe-memory 256K", {"--pe-memory 2M"}},
                    TooSmall{"elements", "cornell_box", "--pe-memory 544K", {"--pe-memory", "--pes", "--elements"}},
                    TooSmall{"one_pe",
                             "two_mirrors",
                             "--pe-memory 1M --pes 1x1 --elements 0.12",
                             {"--pe-memory", "--pes", "--elements"}},
                    TooSmall{"patches",
                             "cornell_box",
                             "--pes 1x1 --pe-memory 1M --patches 50 --elements 50",
                             {"--pe-memory", "--pes", "--patches"}},
                    TooSmall{"hemicube", "cornell_box", "--hemicube 256 --pe-memory 1M", {"--pe-memory", "--hemicube"}},
                    TooSmall{"grid",
                             "cornell_box",
                             "--subspaces 64x64x64 --pe-memory 2M --scheme paper",
                             {"--pe-memory", "--subspaces", "--elements"}},
                    TooSmall{"paper", "colour_bleeding", "--scheme paper --pe-memory 512K", {"--pe-memory"}}),
    [](const auto& too_small) { return std::string(too_small.param.name); });

}  // namespace
}  // namespace torolux::test
