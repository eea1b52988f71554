// SPDX-License-Identifier: MIT
// Measures, records, replays.
#include "host_tools/bench/engine_bench.hpp"

#include <atomic>
#include <chrono>
#include <ctime>
#include <future>
#include <thread>

#include "emulator/engines/engine.hpp"
#include "emulator/engines/qemu/hint_log.hpp"
#include "emulator/engines/qemu/qemu_engine.hpp"
#include "emulator/engines/translated/translated_image.hpp"
#include "emulator/errors.hpp"
#include "emulator/niu/processor_side.hpp"

namespace torolux {
namespace {

constexpr const char* kRecordingEngine = "qemu-recording";
/// Room for what one PE receives. Only what is written takes memory.
constexpr std::size_t kLogBytes = 512U << 20U;

HintLogHead& head_of(SharedMemory& log) {
  return *reinterpret_cast<HintLogHead*>(log.bytes().data());
}

RenderResult render_on(const char* engine, const EngineBenchJob& job,
                       const std::function<bool(const RenderProgress&)>& progress) {
  MachineChoice machine = job.machine;
  machine.engine = engine;
  return render(job.scene, job.camera, job.quality, machine, {}, job.pe_image, progress);
}

/// The render once more, on PEs whose NIUs write down what they do.
std::vector<SharedMemory> record(const EngineBenchJob& job, const std::function<bool(const RenderProgress&)>& progress,
                                 std::uint32_t& local_memory_bytes) {
  std::vector<SharedMemory> logs;
  for (unsigned pe = 0; pe < job.machine.columns * job.machine.rows; ++pe) {
    logs.emplace_back("torolux-hint-log", kLogBytes);
  }
  register_engine(kRecordingEngine, [&logs](const EngineSetup& setup) {
    return make_qemu_engine(setup, QemuHintLogs{HintLogUse::record, logs});
  });
  local_memory_bytes = render_on(kRecordingEngine, job, progress).figures.local_memory_bytes;
  return logs;
}

/// PEs with the image loaded and a log instead of a NIU.
std::vector<PeMemory> pes_without_machine(const Image& image, std::uint32_t local_memory_bytes, std::size_t count) {
  std::vector<PeMemory> pes;
  for (std::size_t i = 0; i < count; ++i) {
    pes.push_back({SharedMemory("torolux-unused-niu", niu_channel_bytes()),
                   SharedMemory("torolux-replayed-pe", mapped_bytes_for(local_memory_bytes)), local_memory_bytes});
    image.load_into(pes.back().local.bytes().first(local_memory_bytes));
  }
  return pes;
}

unsigned threads_of(const EngineBenchJob& job) {
  return job.machine.threads != 0 ? job.machine.threads : std::max(1U, std::thread::hardware_concurrency());
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// All PEs at once, as in the machine, each with its log instead of a NIU.
EngineSpeed replay_on_qemu(const EngineBenchJob& job, std::uint32_t local_memory_bytes,
                           std::vector<SharedMemory>& logs) {
  const Image image = load_image(job.pe_image);
  std::vector<PeMemory> pes = pes_without_machine(image, local_memory_bytes, logs.size());
  const auto engine =
      make_qemu_engine({job.machine.description, image, pes, threads_of(job)}, QemuHintLogs{HintLogUse::replay, logs});
  for (SharedMemory& log : logs) std::atomic_ref(head_of(log).replayed).store(0);
  const auto begin = std::chrono::steady_clock::now();
  engine->start();
  EngineSpeed speed;
  for (SharedMemory& log : logs) {
    while (std::atomic_ref(head_of(log).replayed).load() == 0) {
      engine->check();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    speed.instructions += head_of(log).instructions;
  }
  speed.wall_seconds = seconds_since(begin);
  engine->stop();
  speed.cpu_seconds = engine->cpu_seconds();
  return speed;
}

/// One PE from its start to the end of its log. Returns the CPU time that it took [s].
double replay_translated(const translated::TranslatedImage& code, const PeMemory& memory, SharedMemory& log) {
  timespec begin{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
  const auto local = memory.local.bytes().first(memory.local_memory_bytes);
  HintReplayer niu(log.bytes(), local);
  translated::TranslatedPe pe{};
  code.start(pe, local, memory.local.bytes().size());
  pe.marker = [](void*, std::int32_t, std::uint64_t, std::uint64_t) {};
  bool runs = true;
  while (runs) {
    runs = code.run(pe) == translated::TranslatedImage::Stop::hint;
    if (!runs) break;
    const NiuProcessorSide::Result result = niu.hint(pe.hint_immediate, pe.cycles);
    runs = result.outcome == NiuProcessorSide::Outcome::done;
    pe.cycles = result.clock;
  }
  if (!niu.at_end()) throw MachineFailure("a PE on the translated engine did not repeat what it did on QEMU");
  timespec end{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
  return static_cast<double>(end.tv_sec - begin.tv_sec) + 1e-9 * static_cast<double>(end.tv_nsec - begin.tv_nsec);
}

EngineSpeed replay_on_translated(const EngineBenchJob& job, std::uint32_t local_memory_bytes,
                                 std::vector<SharedMemory>& logs) {
  const Image image = load_image(job.pe_image);
  const std::vector<PeMemory> pes = pes_without_machine(image, local_memory_bytes, logs.size());
  const translated::TranslatedImage code(image, job.machine.description.processor.latency);
  std::vector<double> cpu_seconds(logs.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t pe = next++; pe < logs.size(); pe = next++) {
      cpu_seconds[pe] = replay_translated(code, pes[pe], logs[pe]);
    }
  };
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::future<void>> threads;
  for (unsigned i = 0; i < threads_of(job); ++i) threads.push_back(std::async(std::launch::async, work));
  for (std::future<void>& thread : threads) thread.get();
  EngineSpeed speed;
  speed.wall_seconds = seconds_since(begin);
  for (std::size_t pe = 0; pe < logs.size(); ++pe) {
    speed.cpu_seconds += cpu_seconds[pe];
    speed.instructions += head_of(logs[pe]).instructions;
  }
  return speed;
}

void keep_faster(const EngineSpeed& speed, EngineSpeed& fastest) {
  if (speed.instructions_per_second() > fastest.instructions_per_second()) fastest = speed;
}

/// One render; kept if it was faster than those before.
void measure(const char* engine, const EngineBenchJob& job, const std::function<bool(const RenderProgress&)>& progress,
             EngineResult& result) {
  const RenderFigures figures = render_on(engine, job, progress).figures;
  EngineSpeed speed{0, figures.wall_seconds, figures.machine.engine_seconds};
  for (const PeFigures& pe : figures.machine.pes) speed.instructions += pe.instructions;
  if (speed.instructions_per_second() <= result.machine.instructions_per_second()) return;
  result.machine = speed;
  result.scheduler_seconds = figures.machine.scheduler_seconds;
}

}  // namespace

EngineBenchResult bench_engine(const EngineBenchJob& job, const std::function<void(const char*)>& step,
                               const std::function<bool(const RenderProgress&)>& progress) {
  EngineBenchResult result;
  step("renders on QEMU, and records what each PE receives");
  std::uint32_t local_memory_bytes = 0;
  std::vector<SharedMemory> logs = record(job, progress, local_memory_bytes);
  for (SharedMemory& log : logs) {
    result.whole = result.whole && head_of(log).whole != 0;
  }
  for (unsigned i = 0; i < job.repetitions; ++i) {
    step("renders on each engine, and measures");
    measure("translated", job, progress, result.translated);
    measure("qemu", job, progress, result.qemu);
    step("replays the records to the PEs alone, on each engine");
    keep_faster(replay_on_translated(job, local_memory_bytes, logs), result.translated.bare);
    keep_faster(replay_on_qemu(job, local_memory_bytes, logs), result.qemu.bare);
  }
  return result;
}

}  // namespace torolux
