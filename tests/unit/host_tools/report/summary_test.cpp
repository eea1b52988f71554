// SPDX-License-Identifier: MIT
// Proves: the summary of a known run reads exactly as it should.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/unit/host_tools/report/made_up_run.hpp"

namespace torolux {
namespace {

using testing_support::made_up_figures;
using testing_support::made_up_run;

TEST(Summary, OfAKnownRun) {
  constexpr const char* kExpected = R"(
picture                 room.png (320 x 240)
picture                 out/room.exr (320 x 240)
machine                 2 x 1 PEs of 2 MiB on qemu
subspaces               8 x 4 x 8, balanced
on every PE             150 and 30 of 200 subspaces, 25 % and 50 % of memory
on one PE alone         the light of 1 234 surfaces
network memory          NIU 54.7 KiB, router 20.3 KiB of each PE
virtual time                     cycles               ms
  load                        1 000 000           10.000
  radiosity                  23 456 789          234.568
  ray tracing                 3 000 500           30.005
  total                      27 457 289          274.573
load of the 2 PEs                   min             mean              max
  busy                           50.0 %           62.5 %           75.0 %
  instructions                    1 000            1 500            2 000
  record slots used                  33               39               44
packets                 1 000 sent, 1 000 delivered, 2.50 hops on average
records                 123 456 from 42 shots, 307 200 rays; 11 diverted
credits                 512 of 512 home
energy [W]                         R             G             B         share
  emitted                        100           200            50      100.00 %
  absorbed, diffuse               60           150            40       71.43 %
  absorbed, specular              10             5             1        4.57 %
  unshot                           1             2           0.5        1.00 %
  escaped                         20            30             5       15.71 %
  cut off                          5             8             2        4.29 %
  on back sides                3.999             5           1.5        3.00 %
  closing error                1e-05
wall time               1 min 23 s
)";
  EXPECT_EQ("\n" + summary(made_up_run(), made_up_figures()), kExpected);
}

TEST(Summary, WithoutARadiosityStage) {
  const std::string text = summary(made_up_run(), RenderFigures{});
  EXPECT_NE(text.find("energy                  no radiosity stage\n"), std::string::npos) << text;
}

TEST(Summary, SaysWhatBoundsEachStage) {
  const std::string text = summary(made_up_run(), testing_support::whole_figures());
  EXPECT_NE(text.find("stages             PEs busy unequally  all wait   bounded by\n"
                      "  radiosity             0 %       0 %     100 %   waiting\n"),
            std::string::npos)
      << text;
}

TEST(Summary, FitsOnATerminal) {
  std::istringstream lines(summary(made_up_run(), testing_support::whole_figures()));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 79U) << line;
}

}  // namespace
}  // namespace torolux
