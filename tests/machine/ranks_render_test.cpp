// SPDX-License-Identifier: MIT
// Proves: a render whose PEs run translated on other ranks has the picture, the cycles, the figures and the trace hash
// of one in one process, whatever ranks, threads, placing and delays of messages.
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>

#include "tests/support/on_ranks.hpp"

namespace torolux::test {
namespace {

using remote::Placing;
using std::chrono_literals::operator""us;

RenderCase small_case() {
  RenderCase small = native_case(source_dir() / "scenes" / "cornell_box");
  small.quality.width = small.quality.height = 16;
  small.quality.emission_records = 20'000;
  small.machine.engine = "translated";
  small.machine.columns = 3;
  small.machine.rows = 2;
  small.machine.description.records.credits_per_pe = 256;
  small.machine.threads = 1;
  return small;
}

class RenderOnRanks : public testing::TestWithParam<OnRanks> {
 protected:
  static void SetUpTestSuite() { alone_ = run_case(small_case()); }
  static void TearDownTestSuite() { alone_.reset(); }

  static inline std::optional<RenderResult> alone_;
};

TEST_P(RenderOnRanks, IsTheSame) {
  const RenderResult result = render_on(GetParam(), small_case());
  EXPECT_EQ(result.figures.machine.trace_hash, alone_->figures.machine.trace_hash);
  EXPECT_EQ(exact_figures(result.figures), exact_figures(alone_->figures));
  EXPECT_EQ(bytes_of(result.picture), bytes_of(alone_->picture));
  ASSERT_EQ(result.figures.machine.stages.size(), alone_->figures.machine.stages.size());
  for (std::size_t s = 0; s < result.figures.machine.stages.size(); ++s) {
    for (std::size_t pe = 0; pe < result.figures.machine.pes.size(); ++pe) {
      const PeFigures& one = result.figures.machine.stages[s].figures.pes[pe];
      const PeFigures& other = alone_->figures.machine.stages[s].figures.pes[pe];
      EXPECT_EQ(one.busy_cycles, other.busy_cycles) << s << " " << pe;
      EXPECT_EQ(one.waits, other.waits) << s << " " << pe;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ranks, RenderOnRanks,
                         testing::Values(OnRanks{2, 1, Placing::block, {}}, OnRanks{2, 2, Placing::random, {1, 200us}},
                                         OnRanks{3, 1, Placing::cyclic, {2, 500us}}, OnRanks{3, 2, Placing::block, {}},
                                         OnRanks{5, 1, Placing::random, {3, 50us}},
                                         OnRanks{5, 2, Placing::cyclic, {4, 200us}},
                                         OnRanks{9, 1, Placing::block, {5, 100us}}),
                         [](const auto& on) {
                           return std::to_string(on.param.ranks) + "Ranks" + std::to_string(on.param.threads) +
                                  "Threads";
                         });

}  // namespace
}  // namespace torolux::test
