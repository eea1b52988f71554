// SPDX-License-Identifier: MIT
// Measures, records, replays.
#include "host_tools/bench/engine_bench.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include "emulator/engines/engine.hpp"
#include "emulator/engines/qemu/hint_log.hpp"
#include "emulator/engines/qemu/qemu_engine.hpp"
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

/// All PEs at once, as in the machine, each with its log instead of a NIU.
EngineSpeed replay(const EngineBenchJob& job, std::uint32_t local_memory_bytes, std::vector<SharedMemory>& logs) {
  const Image image = load_image(job.pe_image);
  std::vector<PeMemory> pes;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    pes.push_back({SharedMemory("torolux-unused-niu", niu_channel_bytes()),
                   SharedMemory("torolux-replayed-pe", mapped_bytes_for(local_memory_bytes)), local_memory_bytes});
    image.load_into(pes.back().local.bytes().first(local_memory_bytes));
  }
  const unsigned threads =
      job.machine.threads != 0 ? job.machine.threads : std::max(1U, std::thread::hardware_concurrency());
  const auto engine =
      make_qemu_engine({job.machine.description, image, pes, threads}, QemuHintLogs{HintLogUse::replay, logs});
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
  speed.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  engine->stop();
  speed.cpu_seconds = engine->cpu_seconds();
  return speed;
}

/// One render; kept if it was faster than those before.
void measure(const EngineBenchJob& job, const std::function<bool(const RenderProgress&)>& progress,
             EngineBenchResult& result) {
  const RenderFigures figures = render_on("qemu", job, progress).figures;
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
  step("renders, and records what each PE receives");
  std::uint32_t local_memory_bytes = 0;
  std::vector<SharedMemory> logs = record(job, progress, local_memory_bytes);
  for (SharedMemory& log : logs) {
    result.whole = result.whole && head_of(log).whole != 0;
  }
  for (unsigned i = 0; i < job.repetitions; ++i) {
    step("renders, and measures");
    measure(job, progress, result);
    step("replays the records to the PEs on QEMU alone");
    const EngineSpeed bare = replay(job, local_memory_bytes, logs);
    if (bare.instructions_per_second() > result.bare.instructions_per_second()) result.bare = bare;
  }
  return result;
}

}  // namespace torolux
