// SPDX-License-Identifier: MIT
// Proves: a machine that is looked at while it runs does what it does unseen; what is seen only grows, and is no more
// than the figures at its end; parts of the frame buffer that have changed are named, others are not.
#include <gtest/gtest.h>

#include "emulator/frame_buffer/frame_changes.hpp"
#include "emulator/machine/live_figures.hpp"
#include "tests/unit/emulator/machine/wanderers.hpp"

namespace torolux::test {
namespace {

constexpr std::uint32_t kPerPe = 400, kLife = 12;

struct Looked {
  std::string figures;
  MachineFigures raw;
  std::vector<LiveFigures> looks;
};

Looked run_looked_at() {
  MachineSetup setup = small_machine(3, 3);
  setup.progress_seconds = 0;
  register_native_engine(wanderers(kPerPe, kLife, 8), {});
  CountingHost host(9 * kPerPe);
  const Image image = empty_image();
  Machine machine(setup, image);
  Looked looked;
  machine.run(host, [&](Cycles now) {
    machine.sample(looked.looks.emplace_back());
    EXPECT_EQ(looked.looks.back().now, now);
    return true;
  });
  looked.figures = exact(machine.figures());
  looked.raw = machine.figures();
  return looked;
}

TEST(LiveFigures, ChangeNothing) {
  const Looked looked = run_looked_at();
  ASSERT_GT(looked.looks.size(), 10U);
  CountingHost host(9 * kPerPe);
  EXPECT_EQ(run(small_machine(3, 3), host, wanderers(kPerPe, kLife, 8)).figures, looked.figures);
}

TEST(LiveFigures, GrowUpToTheFiguresOfTheRun) {
  const Looked looked = run_looked_at();
  const std::vector<LiveFigures>& looks = looked.looks;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    ASSERT_EQ(looks[i].pes.size(), 9U);
    for (unsigned pe = 0; pe < 9; ++pe) {
      const LivePe& now = looks[i].pes[pe];
      // Of the two, the one written first may be seen without the other.
      EXPECT_LE(now.clock, looked.raw.pes[pe].cycles);
      for (std::size_t link = 0; link < kLinks; ++link)
        EXPECT_LE(now.link_flits[link], looked.raw.routers[pe].links[link].flits);
      if (i == 0) continue;
      const LivePe& before = looks[i - 1].pes[pe];
      EXPECT_GE(looks[i].now, looks[i - 1].now);
      EXPECT_GE(now.clock, before.clock);
      EXPECT_GE(now.waited, before.waited);
      for (std::size_t link = 0; link < kLinks; ++link) EXPECT_GE(now.link_flits[link], before.link_flits[link]);
    }
  }
  std::uint64_t flits = 0;
  for (const LivePe& pe : looks.back().pes) flits += pe.link_flits[0];
  EXPECT_GT(flits, 0U);
  EXPECT_GT(looks.back().pes[0].waited, 0U);
}

TEST(FrameChanges, NamesRunsThatHaveChanged) {
  FrameChanges changes;
  changes.resize(3 * FrameChanges::kRunPixels + 1);
  ASSERT_EQ(changes.last().size(), 4U);
  changes.note(0, 1);
  changes.note(3 * FrameChanges::kRunPixels, 2);
  changes.note(FrameChanges::kRunPixels - 1, 3);
  EXPECT_EQ(changes.added(), 3U);
  EXPECT_EQ(std::vector<std::uint64_t>(changes.last().begin(), changes.last().end()),
            (std::vector<std::uint64_t>{3, 0, 0, 2}));
}

}  // namespace
}  // namespace torolux::test
