// SPDX-License-Identifier: MIT
// Where PEs stand and which calls led there. Enter: images, local memories, the engine's registers; leaves: lines for
// messages.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulator/engines/engine/engine.hpp"
#include "emulator/engines/image/backtrace.hpp"
#include "emulator/engines/image/debug_info.hpp"
#include "emulator/engines/image/image_set.hpp"

namespace torolux {

class CallStacks {
 public:
  /// All outlive this.
  CallStacks(const ImageSet& images, const std::vector<PeMemory>& pes, Engine& engine);

  const Image& image_of(unsigned pe) const { return images_.of(pe); }
  /// What its local memory holds; to be looked at once it has stopped.
  std::span<const std::byte> memory_of(unsigned pe) const;
  /// Read when it is first asked for.
  const DebugInfo& debug_info_of(unsigned pe);

  /// Of a trap at mepc, by the registers that the image's trap handler has put into `__trap_registers` (start.S); ""
  /// where it has not.
  std::string of_trap(unsigned pe, std::uint32_t mepc);
  /// Of a PE that waits in a HINT, or has ended in one, or at `pc`; "": this engine cannot tell.
  std::string of_pe(unsigned pe, std::optional<std::uint32_t> pc = std::nullopt);

  struct Place {
    std::string words;  ///< "receive at main.c:31, pc 0x80000123"; "": this engine cannot tell
    std::string calls;  ///< as of_pe
  };
  /// Where the program has called the driver or the library that the HINT is part of, else where it is itself.
  Place place_of(unsigned pe);

 private:
  CallStack stack(unsigned pe, const FrameRegisters& innermost);
  std::optional<FrameRegisters> registers_of(unsigned pe);
  std::optional<std::uint32_t> word(unsigned pe, std::uint32_t address) const;

  const ImageSet& images_;
  const std::vector<PeMemory>& pes_;
  Engine& engine_;
  std::vector<std::unique_ptr<DebugInfo>> debug_infos_;  // of each image; null: not yet
};

}  // namespace torolux
