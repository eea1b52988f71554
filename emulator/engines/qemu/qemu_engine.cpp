// SPDX-License-Identifier: MIT
// Starts, watches and ends the QEMU processes. What a PE does at a HINT is in the plugin and in niu/processor_side.
#include "emulator/engines/qemu/qemu_engine.hpp"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <optional>
#include <string>
#include <thread>

#include "emulator/engines/engine/gdb_socket.hpp"
#include "emulator/engines/qemu/gdb_connection.hpp"
#include "emulator/engines/qemu/gdb_registers.hpp"
#include "emulator/engines/qemu/plugin_share.hpp"
#include "emulator/engines/qemu/qemu_process.hpp"
#include "emulator/errors.hpp"
#include "emulator/installed_file.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/ending.hpp"
#include "emulator/niu/processor_side.hpp"

namespace torolux {
namespace {

using Clock = std::chrono::steady_clock;

/// A PE whose plugin shows no sign of life for so long is given up. Generous: a thousand processes may share one core.
constexpr std::chrono::seconds kLongestSilence{120};
/// For a PE to tell its registers; a thousand processes may share one core.
constexpr std::chrono::seconds kLongestLook{5};
/// Nor does a PE run that counts nothing and yet uses so much of a host core [s]: it traps to where nothing is.
constexpr double kMostFruitlessCpuSeconds = 2;

/// RV32IMAFC_Zicsr_Zifencei and nothing more, in machine mode alone; everything else traps.
constexpr const char* kCpu =
    "rv32,d=false,s=false,u=false,h=false,mmu=false,sstc=false,Zihintpause=false,Zfh=false,zba=false,zbb=false,zbc="
    "false,zbs=false,pmp=true";

std::filesystem::path plugin_file() {
  auto file = installed_file("lib/torolux/torolux_qemu_plugin.so", "../lib/torolux_qemu_plugin.so");
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw MachineFailure("the QEMU plugin is missing at " + file.string() + ": build all targets");
  }
  return file;
}

/// In QEMU's options a comma separates, and two are one that does not.
std::string escape_commas(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped.append(c == ',' ? 2 : 1, c);
  }
  return escaped;
}

/// The first `threads` cores of those that we may use; empty where that is all of them.
std::vector<int> cores_for(unsigned threads) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  std::vector<int> cores;
  if (sched_getaffinity(0, sizeof(allowed), &allowed) != 0) {
    return cores;
  }
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(static_cast<std::size_t>(core), &allowed)) {
      cores.push_back(core);
    }
  }
  if (threads == 0 || threads >= cores.size()) {
    cores.clear();
  }
  cores.resize(std::min<std::size_t>(cores.size(), threads));
  return cores;
}

/// What is the same for all PEs of an engine.
struct Launch {
  EngineSetup setup;
  std::optional<QemuHintLogs> logs;
  std::vector<SharedMemory>* meetings;
  std::string plugin;  // as QEMU's option takes it
  std::vector<int> cores;
  bool to_be_saved = false;
  std::vector<std::optional<PeRegisters>> restored;  // by PE; empty: all begin
};

class QemuPe {
 public:
  /// debugger: where one may connect; none: not at all.
  QemuPe(std::size_t number, const Launch& launch, const GdbSocket* debugger);

  std::size_t number() const { return number_; }
  /// Throws MachineFailure where the PE cannot go on. tick: wall time since the last look.
  void check(std::uint64_t most_cycles_between_hints, Clock::duration tick);
  /// It waits in a HINT, or has halted.
  PeRegisters save();
  std::optional<StackRegisters> stack_registers(Clock::duration longest);
  void kill() { process_.kill(); }
  double cpu_seconds() const { return process_.cpu_seconds(); }

 private:
  void end(std::uint64_t clock, const NiuFault& fault);
  void watch_progress(std::uint64_t cycles, Clock::duration tick);
  [[noreturn]] void fail(const std::string& what) const;
  static PluginShare& prepare(SharedMemory& memory, std::size_t number, const Launch& launch, bool debugged);
  static QemuProcess start(std::size_t number, const Launch& launch, const SharedMemory& share,
                           const GdbSocket* debugger, const GdbConnection* line);
  void let_begin(const std::optional<PeRegisters>& registers);

  std::size_t number_;
  std::span<const std::byte> memory_;
  NiuChannel& channel_;
  bool debugged_;
  bool ended_ = false;  // by us
  struct Ending {
    std::uint64_t clock;
    NiuFault fault;
  };
  std::optional<Ending> ending_;  // of which the network does not know yet
  SharedMemory share_memory_;
  PluginShare& share_;
  std::optional<GdbConnection> line_;  // where it is to be saved, or goes on
  QemuProcess process_;
  std::uint64_t last_cycles_ = 0;
  std::uint64_t last_hints_ = 0;
  Clock::duration silence_{};
  double cpu_seconds_before_silence_ = 0;
};

QemuPe::QemuPe(std::size_t number, const Launch& launch, const GdbSocket* debugger)
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

PluginShare& QemuPe::prepare(SharedMemory& memory, std::size_t number, const Launch& launch, bool debugged) {
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

QemuProcess QemuPe::start(std::size_t number, const Launch& launch, const SharedMemory& share,
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

class QemuEngine final : public Engine {
 public:
  QemuEngine(const EngineSetup& setup, const QemuOptions& options)
      : launch_{setup, options.logs, options.meetings, {}, {}, false, {}},
        listens_(options.listens),
        most_cycles_between_hints_(setup.machine.processor.most_cycles_between_hints) {
    for (const GdbEndpoint& endpoint : options.gdb) debugged_.emplace_back(endpoint);
  }

  std::string_view name() const override { return kQemuEngine; }

  void start() override {
    launch_.plugin = escape_commas(plugin_file().string());
    launch_.cores = cores_for(launch_.setup.threads);
    pes_.reserve(launch_.setup.pes.size());
    for (std::size_t pe = 0; pe < launch_.setup.pes.size(); ++pe) {
      if (launch_.setup.runs(pe)) pes_.emplace_back(pe, launch_, debugger_of(pe));
    }
    last_check_ = Clock::now();
    for (GdbSocket& debugger : debugged_) {
      if (listens_) listens_(debugger.endpoint());
      debugger.leave_to_qemu();
    }
  }

  void check() override {
    // Time in which nobody looked (we were stopped, too) does not count as a PE's silence.
    const Clock::time_point now = Clock::now();
    const Clock::duration tick = std::min<Clock::duration>(now - last_check_, std::chrono::seconds(1));
    last_check_ = now;
    for (QemuPe& pe : pes_) {
      pe.check(most_cycles_between_hints_, tick);
    }
  }

  void stop() override {
    for (QemuPe& pe : pes_) {
      pe.kill();
    }
  }

  /// Whoever debugs a PE has its debugger stub.
  bool can_be_saved() const override { return debugged_.empty() && !launch_.logs && launch_.meetings == nullptr; }
  void will_be_saved() override { launch_.to_be_saved = true; }
  PeRegisters save(unsigned pe) override { return of(pe).save(); }
  std::optional<StackRegisters> stack_registers(unsigned pe) override {
    if (pes_.empty()) return std::nullopt;
    const Clock::time_point begin = Clock::now();
    const auto registers = of(pe).stack_registers(looks_ ? Clock::duration(kLongestLook) : Clock::duration::zero());
    looks_ = looks_ && Clock::now() - begin < kLongestLook;
    return registers;
  }
  void restore(unsigned pe, const PeRegisters& registers) override {
    launch_.restored.resize(launch_.setup.pes.size());
    launch_.restored[pe] = registers;
  }

  double cpu_seconds() const override {
    double sum = 0;
    for (const QemuPe& pe : pes_) {
      sum += pe.cpu_seconds();
    }
    return sum;
  }

 private:
  QemuPe& of(std::size_t number) {
    return *std::ranges::find(pes_, number, [](const QemuPe& pe) { return pe.number(); });
  }
  const GdbSocket* debugger_of(std::size_t pe) const {
    const auto found = std::ranges::find(debugged_, pe, [](const GdbSocket& socket) { return socket.endpoint().pe; });
    return found == debugged_.end() ? nullptr : &*found;
  }

  Launch launch_;
  std::vector<GdbSocket> debugged_;
  std::function<void(const GdbEndpoint&)> listens_;
  std::uint64_t most_cycles_between_hints_;
  std::vector<QemuPe> pes_;
  bool looks_ = true;  // PEs have told their registers in time, so far
  Clock::time_point last_check_;
};

}  // namespace

std::unique_ptr<Engine> make_qemu_engine(const EngineSetup& setup, const QemuOptions& options) {
  return std::make_unique<QemuEngine>(setup, options);
}

std::unique_ptr<Engine> make_qemu_engine(const EngineSetup& setup, const QemuHintLogs& logs) {
  return make_qemu_engine(setup, QemuOptions{.logs = logs});
}

}  // namespace torolux
