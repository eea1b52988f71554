// SPDX-License-Identifier: MIT
// Proves: a trace has what its window, its list of PEs and its limit of size ask for; slices are whole and arrows have
// both ends all the same, also where the run fails.
#include "host_tools/trace/perfetto_trace.hpp"

#include <gtest/gtest.h>

#include "tests/support/trace_reader.hpp"

namespace torolux {
namespace {

using testing_support::read_trace;
using testing_support::ReadEvent;
using testing_support::ReadTrace;

constexpr PeState kTraverse = static_cast<PeState>(protocol::Phase::traverse);
constexpr PeState kShade = static_cast<PeState>(protocol::Phase::shade);
constexpr PeState kWaits = kFirstWait + static_cast<PeState>(WaitReason::arrivals);

/// A machine of 3 x 2 PEs that does the same in each run: 1000 cycles, then it ends.
std::string trace_of(TraceChoice choice, bool fails = false, std::optional<Cycles>* full_at = nullptr,
                     Cycles rounds = 1) {
  std::string bytes;
  PerfettoTrace trace(std::move(choice), [&](std::string_view more) { bytes += more; });
  const MachineDescription description;  // 100 MHz: a cycle takes 10 ns
  const PhaseNames phases = built_in_phase_names();
  trace.begin({description, 3, 2, phases});
  trace.stage(0, "first");
  for (Cycles round = 0; round < rounds; ++round) {
    const Cycles t = 1000 * round;
    for (unsigned pe = 0; pe < 6; ++pe) trace.pe_state(pe, t, kTraverse);
    trace.counters(t, 1, {3, 0, 7, 1, 50});
    trace.counters(t, MachineCounters{4, 0, 0, 10, 20, 30});
    trace.bus_state(t + 100, static_cast<std::size_t>(BusKind::pixels));
    for (unsigned pe = 0; pe < 6; ++pe) trace.pe_state(pe, t + 200 + pe, kWaits);
    trace.sent(t + 250, {round * 10 + 1, 1, 4, 16});
    trace.sent(t + 260, {round * 10 + 2, 1, 0, 8});
    trace.bus_state(t + 300, kBusIdle);
    trace.counters(t + 512, 1, {3, 0, 8, 1, 50});
    trace.gauge(t + 550, HostGauge::unshot, 0.5);
    trace.gauge(t + 560, HostGauge::records_in_flight, 12);
    trace.received(t + 600, {round * 10 + 1, 1, 4, 16});
    for (unsigned pe = 0; pe < 6; ++pe) trace.pe_state(pe, t + 700, kShade);
    if (fails) break;
    trace.received(t + 800, {round * 10 + 2, 1, 0, 8});
  }
  if (fails) {
    trace.finish();
  } else {
    trace.end(1000 * rounds);
  }
  if (full_at != nullptr) *full_at = trace.full_at();
  EXPECT_EQ(trace.bytes(), bytes.size());
  return bytes;
}

TraceChoice all() {
  TraceChoice choice;
  choice.arrows = 1;
  return choice;
}

std::uint64_t pe_track(const ReadTrace& trace, unsigned pe) {
  const std::string place = " (x " + std::to_string(pe % 3) + ", y " + std::to_string(pe / 3) + ")";
  return trace.track("PE " + std::to_string(pe) + place, trace.track("row " + std::to_string(pe / 3)));
}

using Lengths = std::map<std::string, std::uint64_t>;

TEST(PerfettoTrace, HasWhatWasTold) {
  const ReadTrace trace = read_trace(trace_of(all()));
  EXPECT_EQ(trace.wrong, std::vector<std::string>());
  EXPECT_EQ(trace.lengths(pe_track(trace, 1)),
            (Lengths{{"traverse", 2010}, {"wait: arrivals", 4990}, {"shade", 3000}}));
  EXPECT_EQ(trace.lengths(trace.track("bus", trace.track("machine"))), (Lengths{{"pixels", 2000}}));
  EXPECT_EQ(trace.lengths(trace.track("stage", trace.track("machine"))), (Lengths{{"first", 10000}}));
  EXPECT_EQ(trace.lengths(trace.track("rounds", trace.track("machine"))), (Lengths{{"round 1", 4500}}));
  EXPECT_EQ(trace.arrows(), 2U);
  // Five counters at first, and the one that has changed.
  std::size_t samples = 0;
  for (const ReadEvent& event : trace.events)
    samples += event.type == ReadEvent::counter && trace.tracks.at(event.track).parent == pe_track(trace, 1) ? 1 : 0;
  EXPECT_EQ(samples, 6U);
}

TEST(PerfettoTrace, AWindowCutsSlicesAndNoArrow) {
  TraceChoice choice = all();
  choice.from = 150;
  choice.to = 255;
  const ReadTrace trace = read_trace(trace_of(choice));
  EXPECT_EQ(trace.wrong, std::vector<std::string>());
  EXPECT_EQ(trace.lengths(pe_track(trace, 5)), (Lengths{{"traverse", 550}, {"wait: arrivals", 500}}));
  EXPECT_EQ(trace.arrows(), 1U);  // the second was sent behind it
  for (const ReadEvent& event : trace.events) {
    if (event.arrow_ends.empty()) continue;
    EXPECT_EQ(event.name + std::to_string(event.time), "received6000");
  }
}

TEST(PerfettoTrace, OtherPesAreLeftOut) {
  TraceChoice choice = all();
  choice.pes = {1, 4};
  const ReadTrace trace = read_trace(trace_of(choice));
  EXPECT_EQ(trace.wrong, std::vector<std::string>());
  EXPECT_NE(pe_track(trace, 1), 0U);
  EXPECT_NE(pe_track(trace, 4), 0U);
  EXPECT_EQ(pe_track(trace, 0), 0U);
  EXPECT_EQ(trace.arrows(), 1U);
}

TEST(PerfettoTrace, ArrowsAreSampledByTheirPackets) {
  TraceChoice choice = all();
  choice.arrows = 4;
  const ReadTrace trace = read_trace(trace_of(choice, false, nullptr, 500));
  EXPECT_EQ(trace.wrong, std::vector<std::string>());
  // Of 1000, each by a chance of 1/4: five standard deviations of 13.7 on either side.
  EXPECT_NEAR(static_cast<double>(trace.arrows()), 250, 70);
  EXPECT_EQ(trace_of(choice, false, nullptr, 500), trace_of(choice, false, nullptr, 500));
  choice.arrows = 0;
  EXPECT_EQ(read_trace(trace_of(choice)).arrows(), 0U);
}

TEST(PerfettoTrace, AFullTraceIsWholeAndSaysSo) {
  TraceChoice choice = all();
  choice.most_bytes = kLeastTraceBytes;
  std::optional<Cycles> full_at;
  const std::string bytes = trace_of(choice, false, &full_at, 500);
  EXPECT_LE(bytes.size(), kLeastTraceBytes);
  EXPECT_GT(bytes.size(), kLeastTraceBytes / 2);
  ASSERT_TRUE(full_at.has_value());
  EXPECT_GT(*full_at, 1000U);
  const ReadTrace trace = read_trace(bytes);
  EXPECT_EQ(trace.wrong, std::vector<std::string>());
  EXPECT_EQ(trace.events.back().annotations.at("left out from cycle"), std::to_string(*full_at));
}

TEST(PerfettoTrace, ARunThatFailsLeavesAWholeTrace) {
  const ReadTrace trace = read_trace(trace_of(all(), true));
  EXPECT_EQ(trace.wrong, std::vector<std::string>());
  EXPECT_EQ(trace.arrows(), 2U);
  EXPECT_EQ(trace.lengths(pe_track(trace, 0)), (Lengths{{"traverse", 2000}, {"wait: arrivals", 5000}}));
  EXPECT_EQ(trace.events.back().name, "still on its way");
}

}  // namespace
}  // namespace torolux
