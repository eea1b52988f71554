// SPDX-License-Identifier: MIT
// The host reads the frame buffer: it has all that came before, waits its turn, and bus and controller are charged.
#include <gtest/gtest.h>

#include "emulator/errors.hpp"
#include "tests/unit/emulator/machine/machine_support.hpp"

namespace torolux::test {
namespace {

/// A PE adds 8 pixels in each of 20 messages, then tells the host, which reads: all that came before has been added.
/// The bus and the controller are charged for what is read.
TEST(FrameRead, HasWhatCameBefore) {
  MachineSetup setup = small_machine(1, 1);
  setup.frame_width = 8;
  setup.frame_height = 1;
  setup.description.frame_buffer.queue_messages = 4;
  setup.description.frame_buffer.cycles_per_pixel = 100;
  register_native_engine([](Niu& niu, NativeClock& /*clock*/) {
    std::array<protocol::PixelAdd, 8> pixels{};
    for (std::uint32_t i = 0; i < pixels.size(); ++i)
      pixels[i] = {{i, -2 * std::int64_t{i}, std::int64_t{1} << 40U}, i, protocol::Plane::colour};
    for (int i = 0; i < 20; ++i) {
      niu.send_message(protocol::kFrameBuffer, static_cast<std::uint16_t>(protocol::MachineMessage::pixels),
                       std::as_bytes(std::span(pixels)));
    }
    niu.send(static_cast<protocol::MessageKind>(kText));
    niu.receive();
    niu.send(static_cast<protocol::MessageKind>(kText));
    sleep_for_ever(niu);
  });
  ListeningHost host(2);
  host.at_message = [&host](HostPort& port, const Heard&) {
    if (host.heard.size() > 1) return;
    port.read_pixels({protocol::Plane::colour, 2, 5});
    port.read_pixels({protocol::Plane::colour, 7, 1});
    port.send_message(0, kGo, {});  // waits for both
  };
  Machine machine(setup, empty_image());
  machine.run(host);
  ASSERT_EQ(host.pixels.size(), 2U);
  EXPECT_EQ(host.pixels[0].read.first, 2U);
  ASSERT_EQ(host.pixels[0].sums.size(), 5U);
  for (std::int64_t i = 0; i < 5; ++i) {
    EXPECT_EQ(host.pixels[0].sums[static_cast<std::size_t>(i)],
              (PixelSums{20 * (i + 2), -40 * (i + 2), std::int64_t{20} << 40U}));
  }
  EXPECT_EQ(host.pixels[1].sums, (std::vector<PixelSums>{{140, -280, std::int64_t{20} << 40U}}));
  const MachineFigures figures = machine.figures();
  EXPECT_EQ(figures.frame_buffer_busy_cycles, 100U * (160 + 6));
  const BusTraffic& pixels = figures.bus.kinds[static_cast<std::size_t>(BusKind::pixels)];
  EXPECT_EQ(pixels.transfers, 22U);
  EXPECT_EQ(pixels.bytes, 20U * (8 + 8 * sizeof(protocol::PixelAdd)) + 2 * (8 + 12) + 6 * 24);
  EXPECT_EQ(figures.pixels_added, 160U);
}

TEST(FrameRead, RefusesPixelsThatAreNotThere) {
  MachineSetup setup = small_machine(1, 1);
  setup.frame_width = setup.frame_height = 4;
  register_native_engine([](Niu& niu, NativeClock& /*clock*/) { sleep_for_ever(niu); });
  for (const FrameRead& read : {FrameRead{protocol::Plane::colour, 10, 7}, FrameRead{protocol::Plane::depth, 0, 1},
                                FrameRead{protocol::Plane::colour, 0, kMostPixelsRead + 1}}) {
    ListeningHost host(1);
    host.at_start = [&read](HostPort& port) { port.read_pixels(read); };
    Machine machine(setup, empty_image());
    EXPECT_THROW(machine.run(host), MachineFailure);
  }
}

}  // namespace
}  // namespace torolux::test
