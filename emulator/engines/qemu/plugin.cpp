// SPDX-License-Identifier: MIT
// The plugin inside each PE's QEMU: counts cycles and instructions of what is translated, and implements the HINT.
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "emulator/engines/isa/instruction_class.hpp"
#include "emulator/engines/qemu/counters.hpp"
#include "emulator/engines/qemu/hint_log.hpp"
#include "emulator/engines/qemu/hint_meeting.hpp"
#include "emulator/engines/qemu/places.hpp"
#include "emulator/engines/qemu/plugin_api.hpp"
#include "emulator/engines/qemu/plugin_share.hpp"
#include "emulator/engines/qemu/stack_registers.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/ending.hpp"
#include "emulator/niu/futex.hpp"
#include "emulator/niu/processor_side.hpp"
#include "firmware/protocol/hints.hpp"
#include "firmware/protocol/machine.hpp"
#include "firmware/protocol/niu_window.hpp"

extern "C" {
__attribute__((visibility("default"))) extern const int qemu_plugin_version;
const int qemu_plugin_version = 1;
__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t* info, int argc,
                                                               char** argv);
}

namespace torolux {
namespace {

/// RISC-V privileged architecture, "Wait for Interrupt".
constexpr std::uint32_t kWaitForInterrupt = 0x1050'0073;

/// While it waits for the emulator it shows that it is alive.
constexpr std::chrono::microseconds kLongestSleep{50'000};

class Plugin {
 public:
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

  void translated(qemu_plugin_tb* block);
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

std::unique_ptr<Plugin> plugin;

std::uint32_t bits_of(const qemu_plugin_insn* instruction) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, qemu_plugin_insn_data(instruction), qemu_plugin_insn_size(instruction) == 2 ? 2 : 4);
  return bits;
}

void on_hint(unsigned /*vcpu*/, void* user_data) {
  plugin->hint(HintPlace::unpack(user_data));
}

void on_block(unsigned /*vcpu*/, void* user_data) {
  plugin->begin(*static_cast<const BlockPlace*>(user_data));
}

void on_instruction(unsigned /*vcpu*/, void* user_data) {
  plugin->count(CountedPlace::unpack(user_data));
}

void on_wait(unsigned /*vcpu*/, void* user_data) {
  plugin->wait_for_interrupt(*static_cast<const WaitPlace*>(user_data));
}

void on_counter(unsigned /*vcpu*/, void* user_data) {
  plugin->read_counter(*static_cast<const CounterPlace*>(user_data));
}

void on_block_behind_counter(unsigned /*vcpu*/, void* user_data) {
  plugin->behind_counter(static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(user_data)));
}

void on_translated(qemu_plugin_id_t /*id*/, qemu_plugin_tb* block) {
  plugin->translated(block);
}

void Plugin::translated(qemu_plugin_tb* block) {
  const std::uint64_t address = qemu_plugin_tb_vaddr(block);
  if (address < protocol::kLocalMemoryBase || address - protocol::kLocalMemoryBase >= share_.local_memory_bytes) {
    return;  // the boot ROM
  }
  look_behind_counter(block, static_cast<std::uint32_t>(address));
  if (share_.counts_instructions != 0) {
    count_each(block);
  } else {
    count_block(block);
  }
}

void Plugin::count_each(qemu_plugin_tb* block) {
  auto address = static_cast<std::uint32_t>(qemu_plugin_tb_vaddr(block));
  for (std::size_t i = 0; i < qemu_plugin_tb_n_insns(block); ++i) {
    qemu_plugin_insn* instruction = qemu_plugin_tb_get_insn(block, i);
    const std::uint32_t bits = bits_of(instruction);
    const auto kind = class_of(bits);
    const bool accesses =
        kind == InstructionClass::load || kind == InstructionClass::store || kind == InstructionClass::atomic;
    const CountedPlace place{address, cycles_of(bits, share_.latency), is_phase_marker(bits), accesses};
    qemu_plugin_register_vcpu_insn_exec_cb(instruction, on_instruction, QEMU_PLUGIN_CB_NO_REGS, place.pack());
    if (protocol::is_hint(bits)) {
      const HintPlace hint{protocol::hint_immediate(bits), 0, 0};
      qemu_plugin_register_vcpu_insn_exec_cb(instruction, on_hint, QEMU_PLUGIN_CB_NO_REGS, hint.pack());
    }
    look_for_rare(instruction, {}, address);
    address += static_cast<std::uint32_t>(qemu_plugin_insn_size(instruction));
  }
}

void Plugin::count(const CountedPlace& place) {
  const bool repeats = place.may_repeat && place.address == last_counted_;
  last_counted_ = place.address;
  if (repeats) return;
  begin({place.address, place.is_marker ? 0U : 1U, place.cycles});
}

/// The loop is found where the limit is passed, so each time in the same place.
void Plugin::begin(const BlockPlace& block) {
  block_ = block;
  if (share_.stack_wanted.load(std::memory_order_relaxed) != 0) tell_stack();
  if (share_.cycles >= patience_ends_ && watches_loops()) {
    tell_stack();
    give_up(end_of_patience(channel_), endless_loop(channel_, block.address));
  }
  share_.cycles += block.cycles;
  share_.instructions += block.instructions;
}

void Plugin::count_block(qemu_plugin_tb* block) {
  HintPlace rest{};
  auto address = static_cast<std::uint32_t>(qemu_plugin_tb_vaddr(block));
  for (std::size_t i = 0; i < qemu_plugin_tb_n_insns(block); ++i) {
    address += static_cast<std::uint32_t>(qemu_plugin_insn_size(qemu_plugin_tb_get_insn(block, i)));
  }
  for (std::size_t i = qemu_plugin_tb_n_insns(block); i-- > 0;) {
    qemu_plugin_insn* instruction = qemu_plugin_tb_get_insn(block, i);
    const std::uint32_t bits = bits_of(instruction);
    if (protocol::is_hint(bits)) {
      rest.immediate = protocol::hint_immediate(bits);
      qemu_plugin_register_vcpu_insn_exec_cb(instruction, on_hint, QEMU_PLUGIN_CB_NO_REGS, rest.pack());
    }
    address -= static_cast<std::uint32_t>(qemu_plugin_insn_size(instruction));
    look_for_rare(instruction, rest, address);
    rest.cycles_left += cycles_of(bits, share_.latency);
    rest.instructions_left += is_phase_marker(bits) ? 0 : 1;
  }
  BlockPlace& place = blocks_[{address, qemu_plugin_tb_n_insns(block)}];
  place = {address, rest.instructions_left, rest.cycles_left};
  qemu_plugin_register_vcpu_tb_exec_cb(block, on_block, QEMU_PLUGIN_CB_NO_REGS, &place);
}

void Plugin::look_for_rare(qemu_plugin_insn* instruction, const HintPlace& rest, std::uint32_t address) {
  const std::uint32_t bits = bits_of(instruction);
  if (bits == kWaitForInterrupt) {
    waits_.push_back({rest, address});
    qemu_plugin_register_vcpu_insn_exec_cb(instruction, on_wait, QEMU_PLUGIN_CB_NO_REGS, &waits_.back());
  } else if (const auto read = counter_read(bits)) {
    counters_.push_back({rest, *read, address + kCounterReadBytes});
    qemu_plugin_register_vcpu_insn_exec_cb(instruction, on_counter, QEMU_PLUGIN_CB_NO_REGS, &counters_.back());
  }
}

/// QEMU ends a block behind each access to a control register. What stands before this block may be something else
/// that looks like one: then no value waits.
void Plugin::look_behind_counter(qemu_plugin_tb* block, std::uint32_t address) {
  if (address - protocol::kLocalMemoryBase < kCounterReadBytes) return;
  std::uint32_t before = 0;
  std::memcpy(&before, &memory_[address - protocol::kLocalMemoryBase - kCounterReadBytes], sizeof before);
  if (!counter_read(before)) return;
  void* where = reinterpret_cast<void*>(std::uintptr_t{address});  // NOLINT(performance-no-int-to-ptr): never followed
  qemu_plugin_register_vcpu_tb_exec_cb(block, on_block_behind_counter, QEMU_PLUGIN_CB_RW_REGS, where);
}

void Plugin::read_counter(const CounterPlace& place) {
  const std::uint64_t clock = share_.cycles - place.rest.cycles_left - cycle_offset_;
  const std::uint64_t instructions = share_.instructions - place.rest.instructions_left - instruction_offset_;
  counter_value_ = {place.next, place.read.destination, place.read.value(clock, instructions)};
}

void Plugin::behind_counter(std::uint32_t address) {
  if (!counter_value_ || counter_value_->next != address) return;
  if (!set_register(counter_value_->destination, counter_value_->value)) {
    constexpr std::string_view kWhy =
        "torolux plugin: a counter (cycle, time, instret, ...) is read, and this QEMU does not export the function "
        "riscv_cpu_gdb_write_register, by which it would get the PE's value. Debian's QEMU 7.2 does; or use "
        "`--engine translated`";
    (void)!write(STDERR_FILENO, kWhy.data(), kWhy.size());
    _exit(1);
  }
  counter_value_.reset();
}

NiuProcessorSide::Result Plugin::answer(std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions) {
  if (meeting != nullptr) {
    return meet(immediate, clock, instructions);
  }
  if (replayer) {
    return replayer->hint(immediate, clock);
  }
  const NiuProcessorSide::Result result = side_.hint(immediate, clock, instructions);
  if (recorder && result.outcome == NiuProcessorSide::Outcome::done) {
    recorder->happened(immediate, result.clock, instructions);
  }
  return result;
}

/// Phase markers are only noted: the emulator looks at them at the next HINT.
NiuProcessorSide::Result Plugin::meet(std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions) {
  using enum NiuProcessorSide::Outcome;
  if (protocol::is_phase_marker(immediate)) {
    meeting->markers.add({clock, instructions, immediate, 0});
    return {done, clock};
  }
  meeting->immediate = immediate;
  meeting->instructions = instructions;
  meeting->clock = clock;
  meeting->turn.store(HintMeeting::of_emulator);
  futex_wake(meeting->turn);
  while (meeting->turn.load() == HintMeeting::of_emulator) {
    futex_wait(meeting->turn, HintMeeting::of_emulator, kLongestSleep);
    share_.hints.fetch_add(1, std::memory_order_relaxed);
  }
  return {meeting->stop != 0 ? stop : done, meeting->clock};
}

void Plugin::end() {
  share_.diverged.store(replayer && !replayer->at_end() ? 1 : 0, std::memory_order_relaxed);
  share_.stopped.store(1, std::memory_order_release);
  _exit(0);
}

/// There are no interrupts: it is the end of the PE, on this engine as on the others.
void Plugin::wait_for_interrupt(const WaitPlace& place) {
  const std::uint64_t clock = share_.cycles - place.rest.cycles_left - cycle_offset_;
  give_up(clock, {NiuFaultCode::wait_for_interrupt, {place.address, 0, 0}});
}

void Plugin::give_up(std::uint64_t clock, const NiuFault& fault) {
  while (!end_with_fault(channel_, clock, fault) && channel_.stopping.load(std::memory_order_seq_cst) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    share_.hints.fetch_add(1, std::memory_order_relaxed);
  }
  end();
}

/// At the start of a block, where QEMU has all registers in memory.
void Plugin::tell_stack() {
  share_.stack.pc = block_.address;
  const std::uint32_t known = read_stack_registers(share_.stack.x) ? 1 : 2;
  share_.stack_wanted.store(0, std::memory_order_relaxed);
  share_.stack_known.store(known, std::memory_order_release);
}

/// The HINT has ended the PE. It is executed once more, like one that waits, and then begins a block; unless it stands
/// alone, without the loop that it should be in.
void Plugin::end_where_it_stands(const HintPlace& place) {
  window_.retry = ending_ ? 0 : 1;
  if (ending_) {
    if (*ending_ == place.immediate && begins_block(place)) tell_stack();
    end();
  }
  ending_ = place.immediate;
}

void Plugin::hint(const HintPlace& place) {
  if (ending_) return end_where_it_stands(place);
  if (retrying_ && begins_block(place)) tell_stack();
  const std::uint64_t counted = share_.cycles - place.cycles_left;
  const std::uint64_t counted_instructions = share_.instructions - place.instructions_left;
  if (retrying_) {
    cycle_offset_ = counted - retry_clock_;
    instruction_offset_ = counted_instructions - retry_instructions_;
  }
  const std::uint64_t clock = counted - cycle_offset_;
  const std::uint64_t instructions = counted_instructions - instruction_offset_;
  const NiuProcessorSide::Result result = answer(place.immediate, clock, instructions);
  if (result.outcome == NiuProcessorSide::Outcome::stop) {
    const bool halts = place.immediate == static_cast<std::int32_t>(protocol::Hint::halt);
    if (halts || !watches_loops() || channel_.stopping.load(std::memory_order_seq_cst) != 0) end();
    return end_where_it_stands(place);
  }
  retrying_ = result.outcome == NiuProcessorSide::Outcome::retry;
  if (retrying_) {
    retry_clock_ = clock;
    retry_instructions_ = instructions;
    share_.retry_clock.store(clock, std::memory_order_relaxed);
    share_.retry_instructions.store(instructions, std::memory_order_relaxed);
    patience_ends_ = counted + channel_.most_cycles_between_hints + 1;  // what the driver's loop takes does not count
  } else {
    share_.stack_known.store(0, std::memory_order_relaxed);
    cycle_offset_ = counted - result.clock;
    patience_ends_ = counted + (end_of_patience(channel_) - result.clock);
  }
  share_.cycles_at_hint.store(share_.cycles, std::memory_order_relaxed);
  share_.hints.fetch_add(1, std::memory_order_relaxed);
}

std::optional<std::span<std::byte>> map_descriptor(int descriptor) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0 || status.st_size <= 0) {
    return std::nullopt;
  }
  const auto bytes = static_cast<std::size_t>(status.st_size);
  void* mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (mapped == MAP_FAILED) {
    return std::nullopt;
  }
  return std::span(static_cast<std::byte*>(mapped), bytes);
}

/// Nothing on success, else what is wrong.
const char* install(qemu_plugin_id_t id, const qemu_info_t& info, std::string_view argument) {
  if (info.version.min > qemu_plugin_version || info.version.cur < qemu_plugin_version) {
    return "this QEMU does not speak version 1 of the plugin interface";
  }
  if (std::string_view(info.target_name) != "riscv32" || !info.system_emulation || info.system.max_vcpus != 1) {
    return "needed: qemu-system-riscv32 with one hart";
  }
  constexpr std::string_view kShare = "share=";
  if (!argument.starts_with(kShare)) {
    return "expected the argument share=DESCRIPTOR";
  }
  const auto share_memory = map_descriptor(std::atoi(argument.substr(kShare.size()).data()));
  if (!share_memory || share_memory->size() < sizeof(PluginShare)) {
    return "the shared memory cannot be mapped";
  }
  auto& share = *reinterpret_cast<PluginShare*>(share_memory->data());
  if (share.version != kPluginShareVersion || share.channel_layout != niu_channel_layout()) {
    return "plugin and emulator are not from the same build";
  }
  const auto channel = map_descriptor(share.channel_descriptor);
  const auto local = map_descriptor(share.local_descriptor);
  if (!channel || !local || channel->size() < niu_channel_bytes() || local->size() < share.local_memory_bytes) {
    return "channel or local memory cannot be mapped";
  }
  const std::span<std::byte> memory = local->first(share.local_memory_bytes);
  plugin = std::make_unique<Plugin>(share, *niu_channel_at(channel->data()), memory,
                                    NiuProcessorSide(*niu_channel_at(channel->data()), memory, share.window_offset));
  if (share.log_use != HintLogUse::none) {
    const auto log = map_descriptor(share.log_descriptor);
    if (!log || log->size() < sizeof(HintLogHead)) {
      return "the log of HINTs cannot be mapped";
    }
    if (share.log_use == HintLogUse::record) {
      plugin->recorder.emplace(*log, memory, share.window_offset);
    } else {
      plugin->replayer.emplace(*log, memory);
    }
  }
  if (share.meeting_descriptor >= 0) {
    const auto meeting = map_descriptor(share.meeting_descriptor);
    if (!meeting || meeting->size() < sizeof(HintMeeting)) {
      return "the meeting place for HINTs cannot be mapped";
    }
    plugin->meeting = reinterpret_cast<HintMeeting*>(meeting->data());
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, on_translated);
  return nullptr;
}

}  // namespace
}  // namespace torolux

int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t* info, int argc, char** argv) {
  const char* problem = torolux::install(id, *info, argc == 1 ? argv[0] : "");
  if (problem != nullptr) {
    const std::string_view prefix = "torolux plugin: ";
    const std::string_view text = problem;
    (void)!write(STDERR_FILENO, prefix.data(), prefix.size());
    (void)!write(STDERR_FILENO, text.data(), text.size());
    return 1;
  }
  return 0;
}
