// SPDX-License-Identifier: MIT
// What the plugin knows of its PE while QEMU runs it. Enter: blocks as QEMU translates them, then each that is executed
// and each HINT; leave: cycles and instructions counted, and what the NIU does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "emulator/engines/qemu/counters.hpp"
#include "emulator/engines/qemu/hint_log.hpp"
#include "emulator/engines/qemu/hint_meeting.hpp"
#include "emulator/engines/qemu/places.hpp"
#include "emulator/engines/qemu/plugin_api.hpp"
#include "emulator/engines/qemu/plugin_share.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/ending.hpp"
#include "emulator/niu/processor_side.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

class Plugin {
 public:
  /// All must outlive it. memory: the PE's local memory.
  Plugin(PluginShare& share, NiuChannel& channel, std::span<std::byte> memory, NiuProcessorSide side)
      : share_(share),
        channel_(channel),
        memory_(memory),
        window_(*reinterpret_cast<protocol::NiuWindow*>(&memory[share.window_offset])),
        side_(side),
        patience_ends_(end_of_patience(channel)),
        retrying_(share.resumes != 0),
        retry_clock_(share.resumed_clock),
        retry_instructions_(share.resumed_instructions) {}

  /// QEMU has translated a block: asks to be told when it is executed.
  void translated(qemu_plugin_tb* block);
  // What QEMU tells when it executes such a place, before that.
  void begin(const BlockPlace& block);
  void count(const CountedPlace& place);
  void hint(const HintPlace& place);
  [[noreturn]] void wait_for_interrupt(const WaitPlace& place);
  void read_counter(const CounterPlace& place);
  void behind_counter(std::uint32_t address);

  // At most one of these is there.
  std::optional<HintRecorder> recorder;
  std::optional<HintReplayer> replayer;
  /// Where the emulator does what HINTs do.
  HintMeeting* meeting = nullptr;

 private:
  void count_block(qemu_plugin_tb* block);
  void count_each(qemu_plugin_tb* block);
  void look_for_rare(qemu_plugin_insn* instruction, const HintPlace& rest, std::uint32_t address);
  void look_behind_counter(qemu_plugin_tb* block, std::uint32_t address);
  NiuProcessorSide::Result answer(std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions);
  NiuProcessorSide::Result meet(std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions);
  bool watches_loops() const { return meeting == nullptr && !replayer; }
  [[noreturn]] void give_up(std::uint64_t clock, const NiuFault& fault);
  [[noreturn]] void end();
  void tell_stack();
  void end_where_it_stands(const HintPlace& place);
  bool begins_block(const HintPlace& place) const { return place.instructions_left + 1 == block_.instructions; }

  PluginShare& share_;
  NiuChannel& channel_;
  std::span<const std::byte> memory_;
  protocol::NiuWindow& window_;
  NiuProcessorSide side_;
  /// By address and length: translated again, a block is the same.
  std::map<std::pair<std::uint32_t, std::size_t>, BlockPlace> blocks_;
  // Each time one is translated: they are rare.
  std::deque<WaitPlace> waits_;
  std::deque<CounterPlace> counters_;
  struct CounterValue {
    std::uint32_t next;
    unsigned destination;
    std::uint32_t value;
  };
  std::optional<CounterValue> counter_value_;  // read, and not yet in its register
  // PE clock = counted cycles - cycle_offset_; the same for instructions. Modulo 2^64: waiting makes it "negative".
  std::uint64_t cycle_offset_ = 0;
  std::uint64_t instruction_offset_ = 0;
  std::uint64_t patience_ends_;  // counted cycles; with no HINT until then it is an endless loop
  // While the NIU driver repeats a HINT: clock and count at its first execution, to which they are set back.
  bool retrying_;
  std::uint64_t retry_clock_;
  std::uint64_t retry_instructions_;
  std::uint32_t last_counted_ = 0;      // address
  BlockPlace block_{};                  // that runs
  std::optional<std::int32_t> ending_;  // a HINT of this immediate has ended the PE, and is executed once more
};

/// From now on this is told what QEMU translates and executes. id: of the plugin, as QEMU knows it.
void run_plugin(qemu_plugin_id_t id, std::unique_ptr<Plugin> one);

}  // namespace torolux
