// SPDX-License-Identifier: MIT
// Proves: lists are multiplied, zipped and varied alone as the plan says, in its order; parts of a study are a
// partition of it.
#include "host_tools/study/points.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "emulator/errors.hpp"
#include "host_tools/study/shard.hpp"

namespace torolux::study {
namespace {

std::vector<std::string> labels(const std::string& text) {
  const Plan plan = parse_plan("[base]\ncommand = 'run'\nimage = 'a.elf'\npes = '4x4'\n" + text, "plan.toml");
  std::vector<std::string> result;
  for (const Point& point : points_of(plan)) result.push_back(label_of(point, varied_names(plan)));
  return result;
}

using testing::ElementsAre;

TEST(Points, WithoutListsAreOne) {
  EXPECT_THAT(labels(""), ElementsAre("base"));
}

TEST(Points, AreTheProductTheFirstSlowest) {
  EXPECT_THAT(labels("[vary]\npes = ['1x1', '2x2']\nengine = ['qemu', 'translated']\n"),
              ElementsAre("pes=1x1, engine=qemu", "pes=1x1, engine=translated", "pes=2x2, engine=qemu",
                          "pes=2x2, engine=translated"));
}

TEST(Points, ZippedListsGoTogether) {
  EXPECT_THAT(labels("[vary]\npes = ['1x1', '2x2']\nengine = ['qemu', 'translated']\npe-memory = ['1M', '2M']\n"
                     "zip = [['pes', 'pe-memory']]\n"),
              ElementsAre("pes=1x1, engine=qemu, pe-memory=1M", "pes=1x1, engine=translated, pe-memory=1M",
                          "pes=2x2, engine=qemu, pe-memory=2M", "pes=2x2, engine=translated, pe-memory=2M"));
}

TEST(Points, OneAtATimeAroundABase) {
  EXPECT_THAT(
      labels("[vary_one]\nmachine.torus.flit_bytes = [1, 64]\nmachine.torus.link_cycles = [10]\n"),
      ElementsAre("base", "machine.torus.flit_bytes=1", "machine.torus.flit_bytes=64", "machine.torus.link_cycles=10"));
  EXPECT_THAT(labels("[vary]\npes = ['1x1', '2x2']\n[vary_one]\npe-memory = ['2M']\n"),
              ElementsAre("pes=1x1", "pes=1x1, pe-memory=2M", "pes=2x2", "pes=2x2, pe-memory=2M"));
}

TEST(Points, RunsOfTheirOwn) {
  EXPECT_THAT(labels("[[run]]\npes = '1x1'\n[[run]]\npes = '2x2'\nengine = 'qemu'\n"),
              ElementsAre("pes=1x1", "pes=2x2, engine=qemu"));
}

TEST(Points, TooManyAreRefused) {
  std::string list = "[0";
  for (int i = 1; i < 330; ++i) list += ", " + std::to_string(i);
  list += "]\n";
  EXPECT_THROW(labels("[vary]\npes = " + list + "engine = " + list), InputError);
}

TEST(Shards, AreAPartition) {
  std::vector<Work> all(23);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].run.key = std::string(1, static_cast<char>('a' + (i * 7) % 23));
  for (const std::size_t parts : {1U, 2U, 5U, 40U}) {
    std::vector<std::string> seen;
    for (std::size_t part = 1; part <= parts; ++part) {
      std::vector<Work> work = all;
      keep_shard(work, all, {part, parts});
      EXPECT_LE(work.size(), (all.size() + parts - 1) / parts);
      for (const Work& one : work) seen.push_back(one.run.key);
    }
    std::ranges::sort(seen);
    EXPECT_EQ(seen.size(), all.size());
    EXPECT_EQ(std::unique(seen.begin(), seen.end()), seen.end());
  }
  EXPECT_EQ(parse_shard("2/5").part, 2U);
  EXPECT_THROW(parse_shard("2"), UsageError);
  EXPECT_THROW(parse_shard("0/5"), InputError);
  for (const char* wrong : {"6/5", "1/0"}) {
    try {
      parse_shard(wrong);
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("--shard: ")) << error.what();
    }
  }
}

}  // namespace
}  // namespace torolux::study
