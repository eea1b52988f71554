// SPDX-License-Identifier: MIT
// A PE on an engine without a machine around it: a test reads the commands that the PE's NIU gives.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emulator/engines/engine_names.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/processor_side.hpp"

namespace torolux::test {

inline std::filesystem::path example_image(const std::string& name) {
  return std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (name + ".elf");
}

/// One command, taken out of the channel.
struct TakenCommand {
  Command head;
  std::vector<std::byte> payload;
};

/// PEs that all run the same image and that nobody answers.
class BarePes {
 public:
  BarePes(const Image& image, std::size_t count, const MachineDescription& machine = {},
          const EngineFactory& factory = engine_named("qemu"));

  Engine& engine() { return *engine_; }
  NiuChannel& channel(std::size_t pe) { return *niu_channel_at(pes_[pe].channel.bytes().data()); }
  std::span<std::byte> local_memory(std::size_t pe) { return pes_[pe].local.bytes(); }
  /// The next command of a PE, or nothing after a minute. Checks the engine meanwhile.
  std::optional<TakenCommand> next_command(std::size_t pe);

 private:
  MachineDescription machine_;
  ImageSet images_;
  std::vector<PeMemory> pes_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace torolux::test
