// SPDX-License-Identifier: MIT
// Starts, watches and ends a QEMU process. What a PE does at a HINT is in the plugin and in niu/processor_side.
#include "emulator/engines/qemu/qemu_pe.hpp"

#include <new>
#include <thread>

#include "emulator/errors.hpp"
#include "emulator/niu/processor_side.hpp"

namespace torolux {
namespace {

using Clock = std::chrono::steady_clock;

/// A PE whose plugin shows no sign of life for so long is given up. Generous: a thousand processes may share one core.
constexpr std::chrono::seconds kLongestSilence{120};
/// Nor does a PE run that counts nothing and yet uses so much of a host core [s]: it traps to where nothing is.
constexpr double kMostFruitlessCpuSeconds = 2;

/// RV32IMAFC_Zicsr_Zifencei and nothing more, in machine mode alone; everything else traps.
constexpr const char* kCpu =
    "rv32,d=false,s=false,u=false,h=false,mmu=false,sstc=false,Zihintpause=false,Zfh=false,zba=false,zbb=false,zbc="
    "false,zbs=false,pmp=true";

}  // namespace

QemuPe::QemuPe(std::size_t number, const QemuLaunch& launch, const GdbSocket* debugger)
    : number_(number),
      memory_(launch.setup.pes[number].local.bytes().first(launch.setup.pes[number].local_memory_bytes)),
      channel_(*niu_channel_at(launch.setup.pes[number].channel.bytes().data())),
      debugged_(debugger != nullptr),
      share_memory_("torolux-share", sizeof(PluginShare)),
      share_(prepare(share_memory_, number, launch, debugged_)),
      line_(launch.to_be_saved || !launch.restored.empty() ? std::optional<GdbConnection>(std::in_place)
                                                           : std::nullopt),
      process_(start(number, launch, share_memory_, debugger, line_ ? &*line_ : nullptr)) {
  if (!line_) return;
  line_->leave_to_qemu();
  let_begin(launch.restored.empty() ? std::nullopt : launch.restored[number]);
}

/// QEMU has stopped where its boot ROM begins.
void QemuPe::let_begin(const std::optional<PeRegisters>& registers) {
  if (registers && registers->halted != 0) {  // it stays where it is
    share_.stopped.store(1);
    return;
  }
  if (registers) write_registers(*line_, *registers);
  line_->let_run();
}

PeRegisters QemuPe::save() {
  if (share_.stopped.load(std::memory_order_acquire) != 0) {
    PeRegisters registers{};
    registers.halted = 1;
    return registers;
  }
  line_->interrupt();
  PeRegisters registers = read_registers_behind_hint(*line_, memory_);
  registers.clock = share_.retry_clock.load(std::memory_order_relaxed);
  registers.instructions = share_.retry_instructions.load(std::memory_order_relaxed);
  line_->let_run();
  return registers;
}

/// One that waits tells them within 50 ms, when it looks whether it may go on; one that runs, at its next block.
std::optional<StackRegisters> QemuPe::stack_registers(Clock::duration longest) {
  const Clock::time_point end = Clock::now() + longest;
  share_.stack_wanted.store(1, std::memory_order_relaxed);
  while (share_.stack_known.load(std::memory_order_acquire) == 0) {
    if (ended_ || share_.stopped.load(std::memory_order_acquire) != 0 || Clock::now() > end || process_.ended()) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (share_.stack_known.load(std::memory_order_acquire) != 1) return std::nullopt;
  return share_.stack;
}

PluginShare& QemuPe::prepare(SharedMemory& memory, std::size_t number, const QemuLaunch& launch, bool debugged) {
  const PeMemory& pe = launch.setup.pes[number];
  auto& share = *new (memory.bytes().data()) PluginShare{};  // placed in memory that SharedMemory owns
  share.version = kPluginShareVersion;
  share.channel_layout = niu_channel_layout();
  share.window_offset = launch.setup.images.of(number).niu_window - protocol::kLocalMemoryBase;
  share.local_memory_bytes = pe.local_memory_bytes;
  share.channel_descriptor = pe.channel.descriptor();
  share.local_descriptor = pe.local.descriptor();
  share.log_descriptor = launch.logs ? launch.logs->logs[number].descriptor() : -1;
  share.log_use = launch.logs ? launch.logs->use : HintLogUse::none;
  share.meeting_descriptor = launch.meetings != nullptr ? (*launch.meetings)[number].descriptor() : -1;
  share.counts_instructions = debugged ? 1 : 0;
  share.latency = launch.setup.machine.processor.latency;
  if (!launch.restored.empty() && launch.restored[number]) {
    share.resumes = 1;
    share.resumed_clock = share.retry_clock = launch.restored[number]->clock;
    share.resumed_instructions = share.retry_instructions = launch.restored[number]->instructions;
  }
  return share;
}

QemuProcess QemuPe::start(std::size_t number, const QemuLaunch& launch, const SharedMemory& share,
                          const GdbSocket* debugger, const GdbConnection* line) {
  const PeMemory& pe = launch.setup.pes[number];
  const std::string memory = std::to_string(pe.local.bytes().size());
  const std::string descriptor = std::to_string(pe.local.descriptor());
  std::vector<std::string> arguments = {
      "qemu-system-riscv32",
      "-machine",
      "virt,memory-backend=ram0",
      "-cpu",
      kCpu,
      "-object",
      "memory-backend-file,id=ram0,share=on,size=" + memory + ",mem-path=/proc/self/fd/" + descriptor,
      "-m",
      "size=" + memory + "B",
      "-accel",
      "tcg,tb-size=4",
      "-bios",
      "none",
      "-nodefaults",
      "-no-user-config",
      "-no-reboot",
      "-display",
      "none",
      "-plugin",
      launch.plugin + ",share=" + std::to_string(share.descriptor())};
  std::vector<int> inherited = {pe.channel.descriptor(), pe.local.descriptor(), share.descriptor()};
  if (launch.logs) {
    inherited.push_back(launch.logs->logs[number].descriptor());
  }
  if (launch.meetings != nullptr) {
    inherited.push_back((*launch.meetings)[number].descriptor());
  }
  if (debugger != nullptr) {
    const std::string socket = std::to_string(debugger->descriptor());
    arguments.insert(arguments.end(), {"-chardev", "socket,id=gdb,server=on,wait=off,nodelay=on,fd=" + socket, "-gdb",
                                       "chardev:gdb", "-S"});
    inherited.push_back(debugger->descriptor());
  }
  if (line != nullptr) {
    arguments.insert(arguments.end(), {"-chardev", "socket,id=line,fd=" + std::to_string(line->qemus_end()), "-gdb",
                                       "chardev:line", "-S"});
    inherited.push_back(line->qemus_end());
  }
  return QemuProcess(arguments, inherited, launch.cores);
}

void QemuPe::fail(const std::string& what) const {
  const std::string log = process_.log_tail();
  throw MachineFailure("PE " + std::to_string(number_) + ": " + what + (log.empty() ? "" : "\nQEMU wrote: " + log));
}

void QemuPe::check(std::uint64_t most_cycles_between_hints, Clock::duration tick) {
  if (ending_ && end_with_fault(channel_, ending_->clock, ending_->fault)) ending_.reset();
  if (ended_) return;
  const bool had_stopped = share_.stopped.load(std::memory_order_acquire) != 0;
  if (had_stopped) {
    if (share_.diverged.load(std::memory_order_relaxed) != 0) {
      fail("did not repeat what it had done when it was recorded");
    }
    return;  // the PE has halted; whatever its process does now is of no interest
  }
  if (const auto why = process_.ended()) {
    if (share_.stopped.load(std::memory_order_acquire) == 0) {
      fail("its QEMU process was " + *why);
    }
    return;
  }
  // Cycles are read first: a HINT in between can only make the difference smaller.
  const std::uint64_t cycles = __atomic_load_n(&share_.cycles, __ATOMIC_ACQUIRE);
  const auto since_hint = static_cast<std::int64_t>(cycles - share_.cycles_at_hint.load(std::memory_order_relaxed));
  // In lock step the PE's place at the channel is another's; else the plugin finds the loop itself.
  if (share_.meeting_descriptor >= 0 && since_hint > 0 &&
      static_cast<std::uint64_t>(since_hint) > most_cycles_between_hints) {
    fail("no HINT for " + std::to_string(since_hint) +
         " cycles: an endless loop? (processor.most_cycles_between_hints = " +
         std::to_string(most_cycles_between_hints) + ")");
  }
  // Whoever debugs a PE may take any time.
  if (!debugged_) watch_progress(cycles, tick);
}

/// The process is dead before its place at the channel is taken.
void QemuPe::end(std::uint64_t clock, const NiuFault& fault) {
  process_.kill();
  ended_ = true;
  if (!end_with_fault(channel_, clock, fault)) ending_ = Ending{clock, fault};
}

void QemuPe::watch_progress(std::uint64_t cycles, Clock::duration tick) {
  const std::uint64_t hints = share_.hints.load(std::memory_order_relaxed);
  if (cycles != last_cycles_ || hints != last_hints_) {
    last_cycles_ = cycles;
    last_hints_ = hints;
    silence_ = Clock::duration::zero();
    return;
  }
  if (silence_ == Clock::duration::zero()) {
    cpu_seconds_before_silence_ = cpu_seconds();
  }
  silence_ += tick;
  if (silence_ > kLongestSilence) {
    fail("its QEMU process has stopped answering");
  }
  if (cpu_seconds() - cpu_seconds_before_silence_ > kMostFruitlessCpuSeconds) {
    if (share_.meeting_descriptor >= 0) fail("executes no instructions any more: did it trap before mtvec was set?");
    const std::uint64_t since_hint = cycles - share_.cycles_at_hint.load(std::memory_order_relaxed);
    end(channel_.processor.last_hint + since_hint, {NiuFaultCode::no_trap_handler, {kUnknownTrap, 0, 0}});
  }
}

}  // namespace torolux
