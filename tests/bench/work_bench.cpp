// SPDX-License-Identifier: MIT
// The PEs' whole work in a small render, with a record of what their NIUs did instead of a machine: translated, and
// the same handlers compiled for this computer. Records once, on QEMU. Host CPU time of one PE after the other.
#include <benchmark/benchmark.h>

#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "emulator/engines/qemu/hint_log.hpp"
#include "emulator/engines/qemu/qemu_engine.hpp"
#include "emulator/engines/translated/translated_image.hpp"
#include "emulator/errors.hpp"
#include "firmware/pe/pe.hpp"
#include "host_tools/render/render.hpp"
#include "host_tools/scene/load_scene.hpp"

namespace torolux::test {
namespace {

/// Room for what one PE receives. Only what is written takes memory.
constexpr std::size_t kLogBytes = 256U << 20U;

struct Recording {
  std::vector<SharedMemory> logs;  ///< one for each PE
  Image image;
  MachineDescription machine;
  std::uint32_t local_memory_bytes = 0;
  std::uint64_t instructions = 0;
};

Recording record(const char* scene_name) {
  Recording recording;
  const std::filesystem::path pe_image = std::filesystem::path(TOROLUX_FIRMWARE_DIR) / "pe.elf";
  recording.image = load_image(pe_image);
  MachineChoice machine;
  machine.engine = "qemu-recording";
  for (unsigned pe = 0; pe < machine.columns * machine.rows; ++pe) {
    recording.logs.emplace_back("torolux-hint-log", kLogBytes);
  }
  register_engine(machine.engine, [&recording](const EngineSetup& setup) {
    return make_qemu_engine(setup, QemuHintLogs{HintLogUse::record, recording.logs});
  });
  const Scene scene = load_scene(std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes" / scene_name, {});
  Quality quality;
  quality.width = quality.height = 64;
  quality.max_shots = 60;
  recording.machine = machine.description;
  recording.local_memory_bytes =
      render(scene, scene.camera.value(), quality, machine, {}, pe_image, {}).figures.local_memory_bytes;
  for (SharedMemory& log : recording.logs) {
    const HintLogHead& head = *reinterpret_cast<const HintLogHead*>(log.bytes().data());
    if (head.whole == 0) throw MachineFailure("the record of the HINTs is not whole");
    recording.instructions += head.instructions;
  }
  return recording;
}

Recording& recording_of(const char* scene) {
  static std::map<std::string, Recording> recordings;
  const auto found = recordings.find(scene);
  return found != recordings.end() ? found->second : recordings.emplace(scene, record(scene)).first->second;
}

/// A PE with the image loaded.
SharedMemory fresh_memory(const Recording& recording) {
  SharedMemory memory("torolux-replayed-pe", mapped_bytes_for(recording.local_memory_bytes));
  recording.image.load_into(memory.bytes().first(recording.local_memory_bytes));
  return memory;
}

struct Replay {
  translated::TranslatedPe pe{};
  HintReplayer& niu;
  bool asked = false, goes_on = true;
};

bool replay_hint(void* context, std::int32_t immediate, std::uint64_t clock, std::uint64_t /*instructions*/) {
  auto& replay = *static_cast<Replay*>(context);
  const NiuProcessorSide::Result result = replay.niu.hint(immediate, clock);
  replay.goes_on = result.outcome == NiuProcessorSide::Outcome::done;
  replay.pe.cycles += result.clock - clock;
  replay.asked = !replay.goes_on;
  return replay.goes_on;
}

void translated_pe(const Recording& recording, const translated::TranslatedImage& code, SharedMemory& memory,
                   HintReplayer& niu) {
  Replay replay{{}, niu};
  code.start(replay.pe, memory.bytes().first(recording.local_memory_bytes), memory.bytes().size());
  replay.pe.marker = [](void*, std::int32_t, std::uint64_t, std::uint64_t) {};
  replay.pe.hint = &replay_hint;
  replay.pe.context = &replay;
  while (replay.goes_on && code.run(replay.pe) == translated::TranslatedImage::Stop::hint) {
    if (!replay.asked) replay_hint(&replay, replay.pe.hint_immediate, replay.pe.cycles, replay.pe.instructions);
    replay.asked = false;
  }
}

struct Ended {};

class ReplayedNiu final : public pe::HintTarget {
 public:
  explicit ReplayedNiu(HintReplayer& niu) : niu_(niu) {}
  void hint(std::int32_t immediate) override {
    if (niu_.hint(immediate, 0).outcome != NiuProcessorSide::Outcome::done) throw Ended();
  }

 private:
  HintReplayer& niu_;
};

void native_pe(const Recording& recording, SharedMemory& memory, HintReplayer& replayer) {
  ReplayedNiu target(replayer);
  std::byte* local = memory.bytes().data();
  auto& page = *reinterpret_cast<pe::NiuPage*>(local + (recording.image.niu_window - protocol::kLocalMemoryBase));
  pe::Niu niu(page, pe::Memory(pe::LocalBase(local, recording.image.stores_begin)), pe::HintGate(target));
  const auto state = std::make_unique<pe::Pe>();
  try {
    pe::run_pe(*state, niu);
    niu.halt();
  } catch (const Ended&) {
  }
}

template <class RunPe>
void replay(benchmark::State& state, const Recording& recording, RunPe run_pe) {
  for (auto _ : state) {
    for (const SharedMemory& log : recording.logs) {
      state.PauseTiming();
      SharedMemory memory = fresh_memory(recording);
      HintReplayer niu(const_cast<SharedMemory&>(log).bytes(), memory.bytes().first(recording.local_memory_bytes));
      state.ResumeTiming();
      run_pe(memory, niu);
      if (!niu.at_end()) state.SkipWithError("a PE did not repeat what it did on QEMU");
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(recording.instructions));
}

void work_translated(benchmark::State& state, const char* scene) {
  const Recording& recording = recording_of(scene);
  const translated::TranslatedImage code(recording.image, recording.machine.processor.latency);
  replay(state, recording,
         [&](SharedMemory& memory, HintReplayer& niu) { translated_pe(recording, code, memory, niu); });
}
void work_native(benchmark::State& state, const char* scene) {
  const Recording& recording = recording_of(scene);
  replay(state, recording, [&](SharedMemory& memory, HintReplayer& niu) { native_pe(recording, memory, niu); });
}

#define TOROLUX_WORK(scene)                         \
  BENCHMARK_CAPTURE(work_translated, scene, #scene) \
      ->Name("work/" #scene "/translated")          \
      ->Unit(benchmark::kMillisecond);              \
  BENCHMARK_CAPTURE(work_native, scene, #scene)->Name("work/" #scene "/native")->Unit(benchmark::kMillisecond)
TOROLUX_WORK(cornell_box);
TOROLUX_WORK(interior);
#undef TOROLUX_WORK

}  // namespace
}  // namespace torolux::test
