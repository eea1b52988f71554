// SPDX-License-Identifier: MIT
// The QEMU engine alone: what a PE's program does reaches the channel, with exact clocks; what ends, is noticed.
#include "emulator/engines/qemu/qemu_engine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/engines/engine_support.hpp"

namespace torolux::test {
namespace {

TEST(QemuEngine, HelloSendsOneLineAndHalts) {
  const Image image = load_image(example_image("hello"));
  BarePes pes(image, 1);
  pes.engine().start();
  const auto text = pes.next_command(0);
  ASSERT_TRUE(text);
  EXPECT_EQ(text->head.kind, CommandKind::send_message);
  const std::string line(reinterpret_cast<const char*>(text->payload.data()), text->payload.size());
  EXPECT_EQ(line, "Hello from PE 0 of 1");
  const auto end = pes.next_command(0);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->head.kind, CommandKind::halt);
  std::printf("%lu %lu instr %lu\n", text->head.time, end->head.time, pes.channel(0).instructions.load());
}

}  // namespace
}  // namespace torolux::test
