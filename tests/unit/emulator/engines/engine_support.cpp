// SPDX-License-Identifier: MIT
// Sets up local memory and channel of each PE as the machine does.
#include "tests/unit/emulator/engines/engine_support.hpp"

#include <thread>

#include "emulator/niu/processor_side.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux::test {
namespace {

PeMemory make_pe(const Image& image, std::size_t number, std::size_t count) {
  constexpr std::uint32_t kBytes = protocol::kSmallestLocalMemory;
  PeMemory pe{SharedMemory("test-channel", niu_channel_bytes()), SharedMemory("test-local", mapped_bytes_for(kBytes)),
              kBytes};
  image.load_into(pe.local.bytes().first(kBytes));
  const std::size_t offset = image.niu_window - protocol::kLocalMemoryBase;
  auto& window = *reinterpret_cast<protocol::NiuWindow*>(pe.local.bytes().data() + offset);
  window.protocol_version = protocol::kProtocolVersion;
  window.pe = static_cast<std::uint32_t>(number);
  window.columns = static_cast<std::uint32_t>(count);
  window.rows = 1;
  window.local_memory_bytes = kBytes;
  NiuChannel& channel = *niu_channel_at(pe.channel.bytes().data());
  channel.torus_queue = 4;
  channel.torus_departures.set_places(channel.torus_queue);
  channel.bus_queue = 4;
  channel.bus_departures.set_places(channel.bus_queue);
  channel.pes = static_cast<std::uint32_t>(count);
  channel.wanted = kNever;
  return pe;
}

}  // namespace

BarePes::BarePes(const Image& image, std::size_t count, const MachineDescription& machine, const EngineFactory& factory)
    : machine_(machine), images_(image) {
  for (std::size_t i = 0; i < count; ++i) {
    pes_.push_back(make_pe(image, i, count));
    channel(i).most_cycles_between_hints = machine_.processor.most_cycles_between_hints;
  }
  engine_ = factory(EngineSetup{machine_, images_, pes_, 1});
}

std::optional<TakenCommand> BarePes::next_command(std::size_t pe) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < deadline) {
    auto& commands = channel(pe).commands;
    if (const Command* command = commands.front()) {
      const auto payload = contents_of(*command);
      TakenCommand taken{*command, {payload.begin(), payload.end()}};
      commands.pop(*command);
      return taken;
    }
    engine_->check();
    if (engine_->help(static_cast<unsigned>(pe), kNever)) continue;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return std::nullopt;
}

}  // namespace torolux::test
