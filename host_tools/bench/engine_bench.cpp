// SPDX-License-Identifier: MIT
// Measures by turns and keeps the fastest.
#include "host_tools/bench/engine_bench.hpp"

#include <algorithm>
#include <thread>

#include "host_tools/run/run.hpp"

namespace torolux {
namespace {

unsigned all_threads() {
  return std::max(1U, std::thread::hardware_concurrency());
}

RenderFigures render_on(const std::string& engine, const RenderBenchJob& job,
                        const std::function<bool(const RenderProgress&)>& progress) {
  MachineChoice machine = job.machine;
  machine.engine = engine;
  return render(job.scene, job.camera, job.quality, machine, {}, job.pe_image, progress).figures;
}

/// One render; kept if it was faster than those before.
void measure(const char* engine, const RenderBenchJob& job, const std::function<bool(const RenderProgress&)>& progress,
             MachineSpeed& fastest) {
  const RenderFigures figures = render_on(engine, job, progress);
  MachineSpeed speed{{figures.machine.instructions(), figures.wall_seconds, figures.machine.engine_seconds},
                     figures.machine.scheduler_seconds};
  if (speed.pes.instructions_per_second() > fastest.pes.instructions_per_second()) fastest = speed;
}

void keep_faster(const EngineSpeed& speed, EngineSpeed& fastest) {
  if (fastest.cpu_seconds == 0 || speed.cpu_seconds < fastest.cpu_seconds) fastest = speed;
}

void replay(Recording& recording, unsigned threads, BareSpeeds& fastest) {
  keep_faster(replay_on_translated(recording, threads), fastest.translated);
  keep_faster(replay_on_qemu(recording, threads), fastest.qemu);
  if (!has_native_program(recording.image)) return;
  if (!fastest.native) fastest.native.emplace();
  keep_faster(replay_natively(recording, threads), *fastest.native);
}

}  // namespace

RenderBenchResult bench_render(const RenderBenchJob& job, const BenchStep& step,
                               const std::function<bool(const RenderProgress&)>& progress) {
  RenderBenchResult result;
  step("renders on QEMU, and records what each PE receives");
  Recording recording = record(load_image(job.pe_image), job.machine.description,
                               std::size_t{job.machine.columns} * job.machine.rows, [&](const std::string& engine) {
                                 const RenderFigures figures = render_on(engine, job, progress);
                                 return RecordedFigures{figures.local_memory_bytes, figures.machine.instructions()};
                               });
  result.whole = recording.whole;
  for (unsigned i = 0; i < job.repetitions; ++i) {
    step("renders on each engine, and measures");
    measure("translated", job, progress, result.translated);
    measure(kQemuEngine, job, progress, result.qemu);
    step("replays the records to the PEs alone, on each engine");
    replay(recording, job.machine.threads != 0 ? job.machine.threads : all_threads(), result.bare);
  }
  return result;
}

BareSpeeds bench_image(const std::filesystem::path& image, unsigned repetitions, const BenchStep& step,
                       const std::function<bool(Cycles)>& progress) {
  MachineSetup setup;
  setup.columns = setup.rows = 1;
  const Image loaded = load_image(image);
  step("runs the innermost loop alone, on each engine");
  Recording recording = record(loaded, setup.description, 1, [&](const std::string& engine) {
    setup.engine = engine;
    const MachineFigures figures = run_image(
        setup, loaded, [](const PeText&) {}, [&](const Machine&, Cycles now) { return !progress || progress(now); });
    return RecordedFigures{setup.local_memory_bytes, figures.instructions()};
  });
  BareSpeeds result;
  for (unsigned i = 0; i < repetitions; ++i) replay(recording, 1, result);
  return result;
}

}  // namespace torolux
