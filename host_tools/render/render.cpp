// SPDX-License-Identifier: MIT
// One render from scene to picture. See render.hpp.
#include "host_tools/render/render.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "emulator/errors.hpp"
#include "firmware/protocol/random.hpp"
#include "host_tools/irradiance/refine.hpp"
#include "host_tools/render/course.hpp"
#include "host_tools/render/drafts.hpp"
#include "host_tools/render/frame_layers.hpp"
#include "host_tools/setup/advice.hpp"
#include "host_tools/setup/record_follower.hpp"
#include "host_tools/setup/setup.hpp"
#include "host_tools/solution/ply_file.hpp"
#include "host_tools/solution/radiosity_file.hpp"
#include "host_tools/stages/render_program.hpp"

namespace torolux {
namespace {

MachineSetup machine_setup(const RenderSetup& setup, const Quality& quality, const MachineChoice& choice) {
  MachineSetup machine;
  machine.description = choice.description;
  machine.columns = choice.columns;
  machine.rows = choice.rows;
  machine.local_memory_bytes = *setup.memory;
  machine.engine = choice.engine;
  machine.debugging = choice.debugging;
  machine.threads = choice.threads;
  machine.frame_width = quality.width;
  machine.frame_height = quality.height;
  machine.frame_layers = quality.layers;
  return machine;
}

void add_figures(const RenderProgram& program, const Machine& machine, const RenderSetup& setup,
                 RenderFigures& figures) {
  const StageTimes& times = program.times();
  figures.radiosity_cycles = times.radiosity - times.loaded;
  figures.load_cycles = times.loaded + (times.loaded_again - times.radiosity);
  figures.machine = machine.figures();
  figures.ray_tracing_cycles = figures.machine.now - times.loaded_again;  // until the last pixel has been added
  figures.rounds = program.rounds();
  figures.radiosity_visits = program.radiosity_visits();
  figures.ray_visits = program.ray_visits();
  figures.shots = program.shots();
  figures.rays = program.rays();
  figures.credits_total = setup.credits;
  figures.credits_home = program.credits_home();
  figures.local_memory_bytes = *setup.memory;
  figures.memory_needed = setup.need.most();
  figures.mean_memory_needed = setup.need.mean();
  figures.subspaces = setup.placement.grid.cells;
  figures.filled_subspaces = setup.placement.filled_cells;
  figures.radiosity_copies = setup.radiosity_copies;
  figures.ray_tracing_copies = setup.ray_tracing_copies;
}

RenderSetup fitting_setup(const Scene& scene, const Camera& camera, const Quality& quality,
                          const MachineChoice& machine, const Image& image, const std::vector<Split>& splits) {
  RenderSetup setup = make_setup(scene, camera, quality, machine, image, splits);
  if (!setup.memory) throw InputError(does_not_fit(scene, camera, quality, machine, image, splits, setup));
  return setup;
}

/// setup: outlives the job.
RenderJob job_of(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                 const RenderSetup& setup, bool radiosity_only) {
  return {scene,
          setup,
          radiosity_settings(scene, setup, quality),
          CameraRays(camera, setup.mesh.space, quality.width, quality.height,
                     PixelSamples(quality.filter, quality.samples, setup.parameters.seed), setup.parameters.seed),
          {setup.credits, quality.width, quality.height, quality.samples, machine.skip_empty_subspaces},
          std::nullopt,
          radiosity_only};
}

/// A file whose flux does not add up is the file's fault, not the machine's.
void check_balance(const std::filesystem::path& file, const Scene& scene, const RenderSetup& setup,
                   const Solution& solution) {
  try {
    balance(scene, setup.mesh, setup.units, solution);
  } catch (const MachineFailure& failure) {
    throw InputError(file.string() + ": damaged: " + failure.what());
  }
}

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

/// Runs one machine of a render after the other, and tells how far they all are.
class Watch {
 public:
  /// from: a checkpoint, from which the first machine goes on; drafts: of that.
  Watch(Course course, Drafts& drafts, CheckpointKeeper* keeper, CheckpointReader* from,
        const std::function<bool(const RenderProgress&)>& progress)
      : course_(std::move(course)), drafts_(drafts), keeper_(keeper), from_(from), progress_(progress) {
    if (from != nullptr) course_.skip_machines(drafts.over ? kDrafts : drafts.round * 2 + drafts.half);
  }
  SnapshotKeeper* keeper() const { return keeper_; }

  void run(Machine& machine, RenderProgram& program) {
    course_.begin_machine();
    CheckpointReader* const from = std::exchange(from_, nullptr);
    if (from != nullptr) program.restore(from->state());
    OneOfRun run(drafts_, program);
    if (keeper_ != nullptr) keeper_->watch(run);
    const auto progress = [&](Cycles now) {
      if (!progress_) return true;
      RenderProgress present = program.progress(now);
      present.overall = course_.share(present);
      return progress_(present) || keeper_ != nullptr;  // who keeps checkpoints ends the run, when it has
    };
    machine.run(program, progress, from != nullptr ? &from->state() : nullptr);
  }

 private:
  Course course_;
  Drafts& drafts_;
  CheckpointKeeper* keeper_;
  CheckpointReader* from_;
  const std::function<bool(const RenderProgress&)>& progress_;
};

/// Solves a draft twice. False: stopped by `progress`.
bool solve_draft(const Scene& scene, const Camera& camera, const Quality& full, const MachineChoice& choice,
                 const Image& image, Watch& watch, RenderSetup& setup, Drafts& drafts) {
  const Quality quality = draft_of(full);
  for (; drafts.half < drafts.light.flux.size(); ++drafts.half) {
    setup.parameters.seed = protocol::hash_combine(machine_seed(full.seed), 2 * drafts.round + drafts.half);
    RenderProgram program(job_of(scene, camera, quality, choice, setup, true));
    MachineSetup of_draft = machine_setup(setup, quality, choice);
    of_draft.keeper = watch.keeper();
    Machine torolux(of_draft, image);
    watch.run(torolux, program);
    if (!program.finished()) return false;
    drafts.cycles += program.times().read;
    drafts.records += program.solution()->tally.rays;
    drafts.light.flux[drafts.half] = incident_flux(*program.solution(), full.shadow_rays);
    drafts.light.of_record = flux_of_record(*program.solution());
  }
  drafts.half = 0;
  return true;
}

/// Finds where the mesh needs more elements. False: stopped by `progress`.
bool solve_drafts(const Scene& scene, const Camera& camera, const Quality& full, const MachineChoice& choice,
                  const Image& image, Watch& watch, Drafts& drafts) {
  for (; drafts.round < kDraftRounds; ++drafts.round) {
    RenderSetup setup = fitting_setup(scene, camera, draft_of(full), choice, image, drafts.splits);
    if (!solve_draft(scene, camera, full, choice, image, watch, setup, drafts)) return false;
    if (drafts.round == 0) drafts.more = static_cast<std::uint64_t>(full.refine * setup.mesh.elements) / kDraftRounds;
    std::vector<Split> chosen = choose_splits(setup.mesh, scene, drafts.light, drafts.more);
    std::vector<Split> all;
    std::set_union(drafts.splits.begin(), drafts.splits.end(), chosen.begin(), chosen.end(), std::back_inserter(all));
    drafts.splits = std::move(all);
  }
  drafts.over = true;
  return true;
}

}  // namespace

RenderResult render(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                    const RenderFiles& files, const std::filesystem::path& pe_image,
                    const std::function<bool(const RenderProgress&)>& progress) {
  const Image image = load_image(pe_image);
  const auto begin = std::chrono::steady_clock::now();
  RenderResult result;
  std::optional<SavedRadiosity> saved;
  Drafts drafts;
  if (files.radiosity) {
    saved = read_radiosity(*files.radiosity);
    check_radiosity(*saved, scene, quality);
    drafts.splits = saved->splits;
  }
  drafts.over = files.radiosity.has_value() || quality.refine <= 0;
  if (files.resume != nullptr) files.resume->state()(drafts);
  std::optional<CheckpointKeeper> keeper;
  if (files.checkpoint.file) keeper.emplace(files.checkpoint);
  Watch watch(Course(quality, files.radiosity.has_value()), drafts, keeper ? &*keeper : nullptr, files.resume,
              progress);
  if (!drafts.over && !solve_drafts(scene, camera, quality, machine, image, watch, drafts)) return result;
  result.figures.draft_cycles = drafts.cycles;
  result.figures.draft_records = drafts.records;
  const std::vector<Split>& splits = drafts.splits;
  const RenderSetup setup = fitting_setup(scene, camera, quality, machine, image, splits);
  RenderJob job = job_of(scene, camera, quality, machine, setup, false);
  const RadiosityOrigin origin = radiosity_origin(scene, quality, setup.mesh);
  if (saved) {
    job.solution = unpack_radiosity(*saved, origin, setup.mesh);
    check_balance(*files.radiosity, scene, setup, *job.solution);
  }

  RenderProgram program(std::move(job));
  MachineSetup of_picture = machine_setup(setup, quality, machine);
  of_picture.watcher = machine.watcher;
  of_picture.record_watcher = machine.follower;
  of_picture.keeper = watch.keeper();
  if (machine.follower != nullptr) machine.follower->begin(scene, setup, quality, machine);
  Machine torolux(of_picture, image);
  const auto run_begin = std::chrono::steady_clock::now();
  try {
    watch.run(torolux, program);
  } catch (const StateSaved&) {
    const bool traces_rays = program.progress(0).stage == RenderStage::ray_tracing;
    if (files.picture_so_far && traces_rays) files.picture_so_far(picture_of(torolux.frame_buffer(), setup));
    throw;
  }
  result.figures.run_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - run_begin).count();

  result.notes = setup.notes;
  add_figures(program, torolux, setup, result.figures);
  result.figures.splits = splits.size();
  result.figures.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!program.finished()) return result;  // stopped by `progress`
  result.figures.energy = balance(scene, setup.mesh, setup.units, *program.solution());
  if (!files.radiosity) result.figures.radiosity_records = program.solution()->tally.rays;
  if (files.save_radiosity) save_radiosity(*files.save_radiosity, origin, splits, *program.solution());
  if (files.save_mesh) {
    const VertexIrradiance irradiance =
        make_vertex_irradiance(setup.mesh, incident_flux(*program.solution(), false), setup.units.watts_per_quantum,
                               setup.units.unit_radiance);
    save_ply(*files.save_mesh, scene, setup.mesh, setup.units, irradiance);
  }
  const FrameBuffer& sums = torolux.frame_buffer();
  result.figures.picture_sha256 = digest_of(sums, protocol::Plane::colour);
  for (const LayerName& layer : layers_in(quality.layers))
    result.figures.layers_sha256.push_back(digest_of(sums, layer.plane));
  result.picture = picture_of(torolux.frame_buffer(), setup);
  result.layers = layers_of(torolux.frame_buffer(), setup);
  return result;
}

}  // namespace torolux
