// SPDX-License-Identifier: MIT
// Proves: what bounds a stage follows from its figures by the rule of docs/statistics.md.
#include "host_tools/report/limits.hpp"

#include <gtest/gtest.h>

namespace torolux {
namespace {

constexpr Cycles kLength = 1000;

/// A stage of kLength cycles from cycle 5000 on, whose PEs are busy for so many of them.
StageFigures stage_with(const std::vector<Cycles>& busy) {
  StageFigures stage;
  stage.begin = 5000;
  stage.figures.now = kLength;
  for (const Cycles cycles : busy) {
    PeFigures pe;
    pe.busy_cycles = cycles;
    stage.figures.pes.push_back(pe);
  }
  return stage;
}

double share(const Limits& limits, Limit limit) {
  return limits.shares[static_cast<std::size_t>(limit)];
}

TEST(Limits, SplitTheLengthByThePes) {
  const Limits limits = limits_of(stage_with({600, 200}), {});
  EXPECT_DOUBLE_EQ(share(limits, Limit::work), 0.4);
  EXPECT_DOUBLE_EQ(share(limits, Limit::balance), 0.2);
  EXPECT_DOUBLE_EQ(share(limits, Limit::waiting), 0.4);
  EXPECT_EQ(limits_of(stage_with({900, 900}), {}).by, Limit::work);
  EXPECT_EQ(limits_of(stage_with({799, 799}), {}).by, Limit::waiting) << "the PEs are a part of the machine, too";
  EXPECT_EQ(limits_of(stage_with({900, 0, 0, 0}), {}).by, Limit::balance);
  EXPECT_EQ(limits_of(stage_with({100, 100}), {}).by, Limit::waiting);
}

TEST(Limits, NameAPartThatIsBusyForFourFifths) {
  StageFigures stage = stage_with({850, 850});
  EXPECT_EQ(limits_of(stage, {}).by, Limit::work);
  stage = stage_with({700, 700});
  stage.figures.host.busy_cycles = 790;
  EXPECT_EQ(limits_of(stage, {}).by, Limit::waiting);
  stage.figures.host.busy_cycles = 800;
  EXPECT_EQ(limits_of(stage, {}).by, Limit::host);
  stage.figures.bus.data_cycles = 900;
  EXPECT_EQ(limits_of(stage, {}).by, Limit::bus) << "the busiest one";
  stage.figures.frame_buffer_busy_cycles = 950;
  EXPECT_EQ(limits_of(stage, {}).by, Limit::frame_buffer);
  stage.figures.routers.resize(2);
  stage.figures.routers[1].links[3].busy = 1000;
  EXPECT_EQ(limits_of(stage, {}).by, Limit::link);
  EXPECT_DOUBLE_EQ(limits_of(stage, {}).share(), 1);
}

TEST(Limits, TellTailsFromOtherWaiting) {
  const StageFigures stage = stage_with({200, 200});  // waiting: 800
  RoundFigures round;
  round.begin = 5000;
  round.chosen = 5100;
  round.last_shot_done = 5500;
  round.end = 5799;
  EXPECT_EQ(limits_of(stage, {round}).by, Limit::waiting) << "100 + 299";
  round.end = 5800;
  EXPECT_EQ(limits_of(stage, {round}).by, Limit::tail);
  RoundFigures other = round;  // of another stage
  other.begin = 6000;
  EXPECT_DOUBLE_EQ(share(limits_of(stage, {round, other}), Limit::tail), 0.4);
}

TEST(Limits, OfAnEmptyStage) {
  EXPECT_DOUBLE_EQ(limits_of(StageFigures{}, {}).share(), 0);
}

}  // namespace
}  // namespace torolux
