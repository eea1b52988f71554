// SPDX-License-Identifier: MIT
// A machine's parameters, its program's job, and its run, with what a checkpoint and whoever looks on must know of it.
#include "host_tools/render/machines.hpp"

#include <utility>

#include "emulator/errors.hpp"
#include "host_tools/render/running_render.hpp"
#include "host_tools/scene/keep_on.hpp"
#include "host_tools/setup/advice.hpp"

namespace torolux {
namespace {

/// A machine of a render, to whoever keeps checkpoints.
class OneOfRun final : public CheckpointedRun {
 public:
  OneOfRun(Drafts& drafts, RenderProgram& program) : drafts_(drafts), program_(program) {}
  std::uint64_t rounds_ended() const override { return program_.rounds_ended(); }
  bool finished() const override { return drafts_.over && program_.finished(); }
  void save(SnapshotWriter& archive) override {
    archive(drafts_);
    program_.save(archive);
  }

 private:
  Drafts& drafts_;
  RenderProgram& program_;
};

}  // namespace

MachineSetup machine_setup(const RenderSetup& setup, const Quality& quality, const MachineChoice& choice) {
  MachineSetup machine;
  machine.description = choice.description;
  machine.columns = choice.columns;
  machine.rows = choice.rows;
  machine.local_memory_bytes = *setup.memory;
  machine.engine = choice.engine;
  machine.debugging = choice.debugging;
  machine.threads = choice.threads;
  machine.ranks = choice.ranks;
  machine.frame_width = quality.width;
  machine.frame_height = quality.height;
  machine.frame_layers = quality.layers;
  machine.progress_seconds = choice.progress_seconds;
  machine.interrupted = choice.interrupted;
  return machine;
}

RenderSetup fitting_setup(const Scene& scene, const Camera& camera, const Quality& quality,
                          const MachineChoice& machine, const Image& image, const std::vector<Split>& splits) {
  RenderSetup setup = make_setup(scene, camera, quality, machine, image, splits);
  if (!setup.memory) throw InputError(does_not_fit(scene, camera, quality, machine, image, splits, setup));
  return setup;
}

RenderJob job_of(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                 const RenderSetup& setup, bool radiosity_only) {
  return {scene,
          setup,
          radiosity_settings(scene, setup, quality),
          CameraRays(camera, setup.mesh.space, quality.width, quality.height,
                     PixelSamples(quality, setup.parameters.seed), setup.parameters.seed),
          {setup.credits,
           quality.width,
           quality.height,
           quality.sample_places(),
           {0, quality.sample_places(), 1},
           machine.skip_empty_subspaces,
           quality.adaptive() ? quality.samples : 0,
           quality.noise},
          std::nullopt,
          radiosity_only};
}

Watch::Watch(Course course, Drafts& drafts, CheckpointKeeper* keeper, CheckpointReader* from,
             const std::function<bool(const RenderProgress&)>& progress)
    : course_(course), drafts_(drafts), keeper_(keeper), from_(from), progress_(progress) {
  if (from != nullptr) course_.skip_machines(drafts.over ? kDrafts : drafts.round * 2 + drafts.half);
}

RenderSetup Watch::next_setup(const Scene& scene, const Camera& camera, const Quality& quality,
                              const MachineChoice& machine, const Image& image) const {
  const HeldInterruption until_saved(keeper_ != nullptr && drafts_.cycles > 0);
  return fitting_setup(scene, camera, quality, machine, image, drafts_.splits);
}

void Watch::run(Machine& machine, RenderProgram& program, const RenderSetup& setup, bool draft, Machine::Then then) {
  course_.begin_machine();
  CheckpointReader* const from = std::exchange(from_, nullptr);
  if (from != nullptr) program.restore(from->state());
  OneOfRun run(drafts_, program);
  if (keeper_ != nullptr) keeper_->watch(run);
  const RunningRender running{machine, program, setup, draft, course_.machines()};
  const auto progress = [&](Cycles now) {
    if (!progress_) return true;
    RenderProgress present = program.progress(now);
    present.running = &running;
    present.overall = course_.share(present);
    if (progress_(present)) return true;
    if (keeper_ == nullptr) return false;
    keeper_->end();  // who keeps checkpoints ends the run, when it has
    return true;
  };
  machine.run(program, progress, then, from != nullptr ? &from->state() : nullptr);
}

}  // namespace torolux
