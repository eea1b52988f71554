// SPDX-License-Identifier: MIT
// A whole machine: memory, engine and network put together, run, and taken apart.
#include "emulator/machine/machine.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <ctime>
#include <numeric>
#include <optional>
#include <thread>

#include "emulator/engines/mixed_engine.hpp"
#include "emulator/errors.hpp"
#include "emulator/machine/emulation.hpp"
#include "emulator/machine/pe_memory.hpp"
#include "emulator/machine/pes_elsewhere.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/processor_side.hpp"
#include "emulator/snapshot/keeper.hpp"
#include "emulator/snapshot/memory.hpp"

namespace torolux {

namespace {

/// The calls of `progress` need not be further apart than asked for because one came a little early.
constexpr double kEarly = 0.95;

/// CPU time of ended child processes [s].
double children_seconds() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void check(const MachineSetup& setup) {
  const std::uint64_t pes = std::uint64_t{setup.columns} * setup.rows;
  if (pes == 0 || pes > protocol::kMostPes) {
    throw UsageError(std::to_string(setup.columns) + "x" + std::to_string(setup.rows) + " PEs: a machine has 1 to " +
                     std::to_string(protocol::kMostPes));
  }
  if (setup.local_memory_bytes < protocol::kSmallestLocalMemory ||
      setup.local_memory_bytes > protocol::kLargestLocalMemory ||
      setup.local_memory_bytes % protocol::kPageBytes != 0) {
    throw UsageError("local memory of " + std::to_string(setup.local_memory_bytes) +
                     " bytes: allowed are whole pages of " + std::to_string(protocol::kPageBytes) + " bytes from " +
                     std::to_string(protocol::kSmallestLocalMemory) + " to " +
                     std::to_string(protocol::kLargestLocalMemory));
  }
  const auto check_queue = [](const char* key, std::uint32_t value) {
    if (value == 0 || value > kMostSendQueue) {
      throw InputError(std::string(key) + " = " + std::to_string(value) + ": allowed are 1 to " +
                       std::to_string(kMostSendQueue));
    }
  };
  check_queue("torus.send_queue_packets", setup.description.torus.send_queue_packets);
  check_queue("bus.send_queue_messages", setup.description.bus.send_queue_messages);
}

}  // namespace

struct Machine::Parts {
  MachineSetup setup;
  ImageSet images;
  PeMemories memory;
  std::vector<NiuChannel*> channels;
  std::unique_ptr<Engine> engine;
  std::optional<CallStacks> stacks;
  std::optional<Emulation> emulation;
  MachineFigures figures;  // of the end of the run
  FrameBuffer frame_buffer;
  FrameChanges frame_changes;
  bool running = false;
  double begin_wall = 0, begin_scheduler = 0, begin_process = 0, begin_children = 0;

  void fill_in_figures() { emulation->fill_in(figures); }
  /// The emulator's own CPU time is the calling thread's, but for PEs that it ran; all other is the engine's. A clock
  /// of CPU time is too slow to be read each time: of what the thread had, PEs and the host's program had the same
  /// shares as of wall time.
  void measure(MachineFigures& out) const {
    const double awake = clock_seconds(CLOCK_MONOTONIC) - begin_wall - emulation->slept_seconds();
    const double own_share = awake > 0 ? std::max(0.0, 1 - engine->help_seconds() / awake) : 1;
    const double of_thread = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - begin_scheduler;
    out.scheduler_seconds = own_share * of_thread;
    out.program_seconds = awake > 0 ? emulation->program_seconds() / awake * of_thread : 0;
    out.engine_seconds = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - begin_process - out.scheduler_seconds +
                         children_seconds() - begin_children + engine->seconds_elsewhere();
  }
  void begin(HostProgram& program, SnapshotReader* from) {
    if ((from != nullptr || setup.keeper != nullptr) && !engine->can_be_saved()) {
      throw UsageError("a machine of the engine " + std::string(engine->name()) +
                       " can neither be saved nor go on from what was saved");
    }
    emulation.emplace(setup, channels, *stacks, *engine, program, images.phase_names());
    if (setup.keeper != nullptr) engine->will_be_saved();
    if (from != nullptr) restore(*from);
    if (setup.debugging.debugger != nullptr) let_debugger_save(program);
    begin_wall = clock_seconds(CLOCK_MONOTONIC);
    begin_scheduler = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    begin_process = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    begin_children = children_seconds();
  }
  /// Whoever goes back to what is saved restores the program, then runs an equal machine from there.
  void let_debugger_save(HostProgram& program) {
    if (setup.keeper != nullptr) {
      throw UsageError("a machine in a debugger's hands cannot be saved: leave out either");
    }
    const auto save_all = [this, &program](SnapshotWriter& archive) {
      program.save(archive);
      emulation->hold_at_rest();
      save(archive);
      emulation->let_go();
    };
    setup.debugging.debugger->may_save(program.can_be_saved() ? PeDebugger::Save(save_all) : nullptr);
  }
  void save(SnapshotWriter& archive) {
    emulation->save(archive);
    for (unsigned pe = 0; pe < memory.pes.size(); ++pe) {
      archive.section("PE");
      PeRegisters registers = engine->save(pe);  // first: only then does the NIU driver know that its HINT waits
      archive(registers);
      engine->bring(pe, 0, setup.local_memory_bytes);
      archive_memory(archive, memory.pes[pe].local.bytes().first(setup.local_memory_bytes));
    }
  }
  void restore(SnapshotReader& archive) {
    emulation->restore(archive);
    for (unsigned pe = 0; pe < memory.pes.size(); ++pe) {
      archive.section("PE");
      PeRegisters registers{};
      archive(registers);
      archive_memory(archive, memory.pes[pe].local.bytes().first(setup.local_memory_bytes));
      engine->restore(pe, registers);
    }
  }
  /// After a message that the host has read.
  void save_if_due() {
    if (!setup.keeper->is_due() || emulation->has_failed()) return;
    emulation->hold_at_rest();
    setup.keeper->keep([this](SnapshotWriter& archive) { save(archive); });
    emulation->let_go();
  }
  void stop_engine() {
    emulation->tell_to_stop();
    engine->stop();
    running = false;
  }
};

Machine::Machine(const MachineSetup& setup, ImageSet images) : parts_(std::make_unique<Parts>()) {
  check(setup);
  if (setup.ranks != nullptr) setup.ranks->check(setup);
  Parts& p = *parts_;
  p.setup = setup;
  p.images = std::move(images);
  const unsigned pes = setup.columns * setup.rows;
  const std::vector<bool> on_qemu = setup.debugging.on_qemu(pes);
  std::vector<unsigned> numbers(pes);
  std::iota(numbers.begin(), numbers.end(), 0U);
  p.memory = setup.ranks != nullptr ? mirrors_of(setup, p.images) : make_pes(setup, p.images, numbers, on_qemu);
  for (const PeMemory& pe : p.memory.pes) p.channels.push_back(niu_channel_at(pe.channel.bytes().data()));
  const unsigned threads = setup.threads != 0 ? setup.threads : std::max(1U, std::thread::hardware_concurrency());
  if (setup.ranks != nullptr) {
    p.engine = setup.ranks->make_engine(setup, p.images, p.memory.pes);
  } else {
    p.engine = make_engine(setup.engine,
                           {p.setup.description,
                            p.images,
                            p.memory.pes,
                            threads,
                            {},
                            setup.profile,
                            setup.debugging.debugger,
                            setup.turns,
                            setup.interrupted},
                           setup.debugging);
  }
  p.stacks.emplace(p.images, p.memory.pes, *p.engine);
}

Machine::~Machine() {
  if (parts_->running) parts_->stop_engine();
}

Cycles PeFigures::idle_cycles() const {
  return std::accumulate(waits.begin(), waits.end(), idle_at_end);
}

Cycles PeFigures::outside_phases() const {
  return busy_cycles - std::accumulate(phase_cycles.begin(), phase_cycles.end(), Cycles{0});
}

std::uint64_t MachineFigures::instructions() const {
  std::uint64_t sum = 0;
  for (const PeFigures& pe : pes) sum += pe.instructions;
  return sum;
}

void Machine::run(HostProgram& program, const std::function<bool(Cycles)>& progress, Then then, SnapshotReader* from) {
  Parts& p = *parts_;
  const bool again = p.running;
  if (p.emulation && !again) throw MachineFailure("the machine's last run has ended");
  if (again) {
    p.emulation->go_on_with(program);
  } else {
    p.begin(program, from);
  }
  double last_progress = 0;
  const auto attend = [&](Cycles now) {
    p.engine->check();
    const double seconds = clock_seconds(CLOCK_MONOTONIC);
    if (!progress || seconds - last_progress < kEarly * p.setup.progress_seconds) return;
    last_progress = seconds;
    if (!progress(now)) throw Interrupted("the run was interrupted");
  };
  try {
    if (!again) p.engine->start();
    p.running = true;
    const auto message_read = [&p] { p.save_if_due(); };
    const bool kept = p.setup.keeper != nullptr && !again;  // the keeper knows the first program alone
    p.emulation->run(attend, kept ? std::function<void()>(message_read) : nullptr);
  } catch (...) {
    p.stop_engine();
    throw;
  }
  p.fill_in_figures();
  if (then == Then::end) end();
}

void Machine::end() {
  Parts& p = *parts_;
  if (!p.running) return;
  p.emulation->end_watch(p.figures.now);
  p.stop_engine();
  p.measure(p.figures);
}

void Machine::begin_picture(std::uint32_t width, std::uint32_t height, std::uint32_t layers) {
  if (!parts_->running) throw MachineFailure("a picture begins while the machine does not run");
  parts_->emulation->begin_picture(width, height, layers);
}

void Machine::sample(LiveFigures& figures) const {
  if (parts_->emulation) parts_->emulation->sample(figures);
}

const FrameBuffer& Machine::frame_buffer() const {
  return parts_->emulation ? parts_->emulation->frame_buffer() : parts_->frame_buffer;
}

const FrameChanges& Machine::frame_changes() const {
  return parts_->emulation ? parts_->emulation->frame_changes() : parts_->frame_changes;
}

std::span<const std::byte> Machine::local_memory(unsigned pe) const {
  parts_->engine->bring(pe, 0, parts_->setup.local_memory_bytes);
  return parts_->memory.pes.at(pe).local.bytes().first(parts_->setup.local_memory_bytes);
}

std::string Machine::where_pes_stand() const {
  return parts_->running ? parts_->emulation->where_pes_stand() : "";
}

MachineFigures Machine::figures() const {
  Parts& p = *parts_;
  if (p.running) {
    p.fill_in_figures();
    p.measure(p.figures);
  }
  return p.figures;
}

}  // namespace torolux
