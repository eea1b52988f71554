// SPDX-License-Identifier: MIT
// Records, replays.
#include "host_tools/bench/replay.hpp"

#include <atomic>
#include <chrono>
#include <ctime>
#include <future>
#include <map>
#include <thread>

#include "emulator/clock_seconds.hpp"
#include "emulator/engines/engine_names.hpp"
#include "emulator/engines/qemu/hint_log.hpp"
#include "emulator/engines/qemu/qemu_engine.hpp"
#include "emulator/engines/translated/run/translated_image.hpp"
#include "emulator/errors.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/processor_side.hpp"

namespace torolux {
namespace {

constexpr const char* kRecordingEngine = "qemu-recording";
/// Room for what one PE receives. Only what is written takes memory.
constexpr std::size_t kLogBytes = 512U << 20U;

const HintLogHead& head_of(const SharedMemory& log) {
  return *reinterpret_cast<const HintLogHead*>(log.bytes().data());
}

/// PEs with the image loaded, and nothing at their NIUs.
std::vector<PeMemory> pes_without_machine(const Recording& recording) {
  std::vector<PeMemory> pes;
  const std::uint32_t bytes = recording.local_memory_bytes;
  for (std::size_t i = 0; i < recording.logs.size(); ++i) {
    pes.push_back({SharedMemory("torolux-unused-niu", niu_channel_bytes()),
                   SharedMemory("torolux-replayed-pe", mapped_bytes_for(bytes)), bytes});
    recording.image.load_into(pes.back().local.bytes().first(bytes));
  }
  return pes;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Runs one PE from its start to the end of its log.
using ReplayPe = std::function<void(HintReplayer& niu, const PeMemory& memory)>;

/// Takes PE after PE on each of the threads.
EngineSpeed replay_here(Recording& recording, unsigned threads, const ReplayPe& replay) {
  const std::vector<PeMemory> pes = pes_without_machine(recording);
  std::vector<double> cpu_seconds(pes.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t pe = next++; pe < pes.size(); pe = next++) {
      const double begin = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
      HintReplayer niu(recording.logs[pe].bytes(), pes[pe].local.bytes().first(pes[pe].local_memory_bytes));
      replay(niu, pes[pe]);
      if (!niu.at_end()) throw MachineFailure("PE " + std::to_string(pe) + " did not repeat what it did on QEMU");
      cpu_seconds[pe] = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
    }
  };
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::future<void>> workers;
  for (unsigned i = 0; i < threads; ++i) workers.push_back(std::async(std::launch::async, work));
  for (std::future<void>& worker : workers) worker.get();
  EngineSpeed speed{recording.instructions, seconds_since(begin), 0};
  for (const double seconds : cpu_seconds) speed.cpu_seconds += seconds;
  return speed;
}

/// A translated PE, and the log in the place of its NIU.
struct ReplayedPe {
  translated::TranslatedPe pe{};
  HintReplayer& niu;
  bool asked = false;  ///< the HINT at which the code has stopped
  bool goes_on = true;

  static bool hint(void* context, std::int32_t immediate, std::uint64_t clock, std::uint64_t /*instructions*/) {
    auto& self = *static_cast<ReplayedPe*>(context);
    const NiuProcessorSide::Result result = self.niu.hint(immediate, clock);
    self.goes_on = result.outcome == NiuProcessorSide::Outcome::done;
    self.asked = !self.goes_on;
    self.pe.cycles += result.clock - clock;
    return self.goes_on;
  }
};

void run_translated(const translated::TranslatedImage& code, HintReplayer& niu, const PeMemory& memory) {
  ReplayedPe replayed{{}, niu};
  translated::TranslatedPe& pe = replayed.pe;
  code.start(pe, memory.local.bytes().first(memory.local_memory_bytes), memory.local.bytes().size());
  pe.marker = [](void*, std::int32_t, std::uint64_t, std::uint64_t) {};
  pe.hint = &ReplayedPe::hint;
  pe.context = &replayed;
  while (replayed.goes_on && code.run(pe) == translated::TranslatedImage::Stop::hint) {
    // Interpreted code stops at a HINT without having asked.
    if (!replayed.asked) ReplayedPe::hint(&replayed, pe.hint_immediate, pe.cycles, pe.instructions);
    replayed.asked = false;
  }
}

std::map<std::string, NativeProgram, std::less<>>& native_programs() {
  static std::map<std::string, NativeProgram, std::less<>> programs;
  return programs;
}

std::string stem_of(const Image& image) {
  return image.file.stem().string();
}

}  // namespace

Recording record(const Image& image, const MachineDescription& machine, std::size_t pes, const RecordedRun& run) {
  Recording recording{image, machine, 0, 0, {}, true};
  for (std::size_t pe = 0; pe < pes; ++pe) recording.logs.emplace_back("torolux-hint-log", kLogBytes);
  register_engine(kRecordingEngine, [&logs = recording.logs](const EngineSetup& setup) {
    return make_qemu_engine(setup, QemuHintLogs{HintLogUse::record, logs});
  });
  const RecordedFigures figures = run(kRecordingEngine);
  recording.local_memory_bytes = figures.local_memory_bytes;
  std::uint64_t logged = 0;
  for (const SharedMemory& log : recording.logs) {
    logged += head_of(log).instructions;
    recording.whole = recording.whole && head_of(log).whole != 0;
  }
  recording.instructions = recording.whole ? figures.instructions : logged;
  return recording;
}

EngineSpeed replay_on_qemu(Recording& recording, unsigned threads) {
  std::vector<PeMemory> pes = pes_without_machine(recording);
  const auto engine = make_qemu_engine({recording.machine, recording.image, pes, threads},
                                       QemuHintLogs{HintLogUse::replay, recording.logs});
  const auto replayed = [](SharedMemory& log) {
    return std::atomic_ref(reinterpret_cast<HintLogHead*>(log.bytes().data())->replayed);
  };
  for (SharedMemory& log : recording.logs) replayed(log).store(0);
  const auto begin = std::chrono::steady_clock::now();
  engine->start();
  for (SharedMemory& log : recording.logs) {
    while (replayed(log).load() == 0) {
      engine->check();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  const double wall_seconds = seconds_since(begin);
  engine->stop();
  return {recording.instructions, wall_seconds, engine->cpu_seconds()};
}

EngineSpeed replay_on_translated(Recording& recording, unsigned threads) {
  const translated::TranslatedImage code(recording.image, recording.machine.processor.latency);
  return replay_here(recording, threads,
                     [&](HintReplayer& niu, const PeMemory& memory) { run_translated(code, niu, memory); });
}

void register_native_program(std::string_view image, NativeProgram program) {
  native_programs()[std::string(image)] = std::move(program);
}

bool has_native_program(const Image& image) {
  return native_programs().contains(stem_of(image));
}

EngineSpeed replay_natively(Recording& recording, unsigned threads) {
  const NativeProgram& program = native_programs().at(stem_of(recording.image));
  return replay_here(recording, threads, [&](HintReplayer& niu, const PeMemory& memory) {
    // A HINT's cost in cycles is the log's affair: at clock 0 none is too late for its entry.
    program(recording.image, memory.local.bytes().first(memory.local_memory_bytes),
            [&](std::int32_t immediate) { return niu.hint(immediate, 0).outcome == NiuProcessorSide::Outcome::done; });
  });
}

}  // namespace torolux
