// SPDX-License-Identifier: MIT
// What `torolux bench engine` compares: every engine, and the handlers as native code, repeat what the PEs of a render
// did, to the last HINT; and one that does not is told, not measured.
#include "host_tools/bench/replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emulator/engines/qemu/hint_log.hpp"
#include "emulator/errors.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

Recording record_cornell() {
  RenderCase cornell = native_case(source_dir() / "scenes" / "cornell_box");
  cornell.quality.max_shots = 2;
  cornell.quality.hemicube = 8;
  cornell.quality.emission_records = 2000;
  cornell.machine = {};
  cornell.machine.columns = cornell.machine.rows = 2;
  return record(load_image(pe_image()), cornell.machine.description, 4, [&](const std::string& engine) {
    cornell.machine.engine = engine;
    const RenderFigures figures = run_case(cornell).figures;
    return RecordedFigures{figures.local_memory_bytes, figures.machine.instructions()};
  });
}

TEST(Replay, EveryEngineRepeatsTheRun) {
  Recording recording = record_cornell();
  EXPECT_TRUE(recording.whole);
  ASSERT_TRUE(has_native_program(recording.image));
  for (const auto replay : {replay_on_qemu, replay_on_translated, replay_natively}) {
    const EngineSpeed speed = replay(recording, 2);
    EXPECT_EQ(speed.instructions, recording.instructions);
    EXPECT_GT(speed.cpu_seconds, 0);
  }
}

TEST(Replay, APeThatDoesSomethingElseIsTold) {
  Recording recording = record_cornell();
  // The last of PE 2's HINTs becomes another one: entries are found from the log's beginning.
  const std::span<std::byte> log = recording.logs[2].bytes();
  auto at = [&](std::uint64_t offset) { return log.data() + sizeof(HintLogHead) + offset; };
  const std::uint64_t used = reinterpret_cast<const HintLogHead*>(log.data())->used;
  HintLogEntry* last = nullptr;
  for (std::uint64_t offset = 0; offset < used;) {
    last = reinterpret_cast<HintLogEntry*>(at(offset));
    offset += sizeof(HintLogEntry);
    for (std::uint32_t i = 0; i < last->patches; ++i) {
      offset += sizeof(HintLogPatch) + (reinterpret_cast<const HintLogPatch*>(at(offset))->bytes + 7) / 8 * 8;
    }
  }
  ++last->immediate;
  const auto throws = testing::Throws<MachineFailure>(
      testing::Property(&MachineFailure::what, testing::HasSubstr("did not repeat what it")));
  EXPECT_THAT([&] { replay_on_translated(recording, 1); }, throws);
  EXPECT_THAT([&] { replay_natively(recording, 1); }, throws);
}

}  // namespace
}  // namespace torolux::test
