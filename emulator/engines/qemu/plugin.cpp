// SPDX-License-Identifier: MIT
// The plugin inside each PE's QEMU: counts cycles and instructions of what is translated, and implements the HINT.
#include "emulator/engines/qemu/plugin.hpp"

#include <unistd.h>

#include <chrono>
#include <cstring>
#include <memory>
#include <string_view>
#include <thread>
#include <utility>

#include "emulator/engines/isa/instruction_class.hpp"
#include "emulator/engines/qemu/stack_registers.hpp"
#include "emulator/niu/ending.hpp"
#include "emulator/niu/futex.hpp"
#include "firmware/protocol/hints.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {
namespace {

/// RISC-V privileged architecture, "Wait for Interrupt".
constexpr std::uint32_t kWaitForInterrupt = 0x1050'0073;

/// While it waits for the emulator it shows that it is alive.
constexpr std::chrono::microseconds kLongestSleep{50'000};

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

}  // namespace

void run_plugin(qemu_plugin_id_t id, std::unique_ptr<Plugin> one) {
  plugin = std::move(one);
  qemu_plugin_register_vcpu_tb_trans_cb(id, on_translated);
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

}  // namespace torolux
