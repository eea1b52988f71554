// SPDX-License-Identifier: MIT
// One render from scene to picture, and views of the solved scene after it.
#include "host_tools/render/render.hpp"

#include <chrono>
#include <utility>

#include "emulator/errors.hpp"
#include "host_tools/render/drafts.hpp"
#include "host_tools/render/frame_layers.hpp"
#include "host_tools/render/machines.hpp"
#include "host_tools/render/session.hpp"
#include "host_tools/setup/record_follower.hpp"
#include "host_tools/solution/ply_file.hpp"
#include "host_tools/solution/radiosity_file.hpp"
#include "host_tools/stages/view_program.hpp"

namespace torolux {
namespace {

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

/// A file whose flux does not add up is the file's fault, not the machine's.
void check_balance(const std::filesystem::path& file, const Scene& scene, const RenderSetup& setup,
                   const Solution& solution) {
  try {
    balance(scene, setup.mesh, setup.units, solution);
  } catch (const MachineFailure& failure) {
    throw InputError(file.string() + ": damaged: " + failure.what());
  }
}

/// What a machine tells the one watcher that it has is told whoever follows a record now.
class FollowerRelay final : public RecordWatcher {
 public:
  RecordWatcher* to = nullptr;

  void sent(Cycles time, const RecordPacket& packet) override {
    if (to != nullptr) to->sent(time, packet);
  }
  void received(Cycles time, const RecordPacket& packet) override {
    if (to != nullptr) to->received(time, packet);
  }
  void came(Cycles time, const BusMessage& message) override {
    if (to != nullptr) to->came(time, message);
  }
  void end(Cycles time) override {
    if (to != nullptr) to->end(time);
  }
};

}  // namespace

struct RenderSession::Parts {
  const Scene& scene;
  const Camera& camera;
  const Quality& quality;
  const MachineChoice& choice;
  const RenderFiles& files;
  const std::function<bool(const RenderProgress&)>& progress;
  Image image;
  std::optional<RenderSetup> setup;
  FollowerRelay relay;
  std::optional<Machine> machine;
  std::optional<Solution> solved;

  MachineSetup of_picture(SnapshotKeeper* keeper, Machine::Then then) {
    MachineSetup machine_setup = torolux::machine_setup(*setup, quality, choice);
    machine_setup.watcher = choice.watcher;
    machine_setup.record_watcher = choice.follower;
    relay.to = choice.follower;
    const bool may_follow_later = then == Machine::Then::stay && choice.ranks == nullptr;
    if (may_follow_later) machine_setup.record_watcher = &relay;
    machine_setup.pacer = choice.pacer;
    machine_setup.hop_watcher = choice.hop_watcher;
    machine_setup.profile = choice.profile;
    machine_setup.turns = choice.turns;
    machine_setup.keeper = keeper;
    return machine_setup;
  }

  void write_files(const RadiosityOrigin& origin, const std::vector<Split>& splits, const Solution& solution) const {
    if (files.save_radiosity) save_radiosity(*files.save_radiosity, origin, splits, solution);
    if (!files.save_mesh) return;
    const VertexIrradiance irradiance = make_vertex_irradiance(
        setup->mesh, incident_flux(solution, false), setup->units.watts_per_quantum, setup->units.unit_radiance);
    save_ply(*files.save_mesh, scene, setup->mesh, setup->units, irradiance);
  }

  void take_picture(RenderResult& result, const SampleCounts& samples) const {
    const FrameBuffer& sums = machine->frame_buffer();
    result.figures.picture_sha256 = digest_of(sums, protocol::Plane::colour);
    for (const LayerName& layer : layers_in(quality.layers))
      result.figures.layers_sha256.push_back(digest_of(sums, layer.plane));
    result.picture = picture_of(sums, *setup, samples);
    result.layers = layers_of(sums, *setup, samples);
  }
};

RenderSession::RenderSession(const Scene& scene, const Camera& camera, const Quality& quality,
                             const MachineChoice& machine, const RenderFiles& files,
                             const std::filesystem::path& pe_image,
                             const std::function<bool(const RenderProgress&)>& progress)
    : parts_(new Parts{scene, camera, quality, machine, files, progress, load_image(pe_image), {}, {}, {}, {}}) {}
RenderSession::~RenderSession() = default;

RenderResult RenderSession::run(Machine::Then then) {
  Parts& p = *parts_;
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  const auto begin = Clock::now();
  RenderResult result;
  std::optional<SavedRadiosity> saved;
  Drafts drafts;
  if (p.files.radiosity) {
    saved = read_radiosity(*p.files.radiosity);
    check_radiosity(*saved, p.scene, p.quality);
    drafts.splits = saved->splits;
  }
  drafts.over = saved || p.quality.refine <= 0;
  if (p.files.resume != nullptr) p.files.resume->state()(drafts);
  std::optional<CheckpointKeeper> keeper;
  if (p.files.checkpoint.file) keeper.emplace(p.files.checkpoint);
  Watch watch(Course(p.quality, saved.has_value()), drafts, keeper ? &*keeper : nullptr, p.files.resume, p.progress);
  if (!drafts.over && !solve_drafts(p.scene, p.camera, p.quality, p.choice, p.image, watch, drafts)) return result;
  result.figures.draft_cycles = drafts.cycles;
  result.figures.draft_records = drafts.records;
  const RenderSetup& setup = p.setup.emplace(watch.next_setup(p.scene, p.camera, p.quality, p.choice, p.image));
  RenderJob job = job_of(p.scene, p.camera, p.quality, p.choice, setup, false);
  const RadiosityOrigin origin = radiosity_origin(p.scene, p.quality, setup.mesh);
  if (saved) {
    job.solution = unpack_radiosity(*saved, origin, setup.mesh);
    check_balance(*p.files.radiosity, p.scene, setup, *job.solution);
  }

  RenderProgram program(std::move(job));
  if (p.choice.follower != nullptr) p.choice.follower->begin(p.scene, setup, p.quality, p.choice);
  Machine& machine = p.machine.emplace(p.of_picture(watch.keeper(), then), p.image);
  const auto run_begin = Clock::now();
  try {
    watch.run(machine, program, setup, false, then);
  } catch (const StateSaved&) {
    const bool traces_rays = program.progress(0).stage == RenderStage::ray_tracing;
    if (p.files.picture_so_far && traces_rays)
      p.files.picture_so_far(picture_of(machine.frame_buffer(), setup, program.samples()));
    throw;
  }
  result.figures.run_seconds = seconds_since(run_begin);

  result.notes = setup.notes;
  add_figures(program, machine, setup, result.figures);
  result.figures.splits = drafts.splits.size();
  result.figures.wall_seconds = seconds_since(begin);
  if (!program.finished()) return result;  // stopped by `progress`
  result.figures.energy = balance(p.scene, setup.mesh, setup.units, *program.solution());
  if (!p.files.radiosity) {
    const protocol::Tally& tally = program.solution()->tally;
    result.figures.radiosity_records = tally.rays + tally.gather_rays;
  }
  p.write_files(origin, drafts.splits, *program.solution());
  p.take_picture(result, program.samples());
  p.solved = program.take_solution();
  return result;
}

bool RenderSession::view(const View& view, const std::function<bool()>& wanted, RecordFollower* follower) {
  Parts& p = *parts_;
  const RenderSetup& setup = p.setup.value();
  const CameraRays rays(view.camera, setup.mesh.space, view.width, view.height,
                        PixelSamples(p.quality, setup.parameters.seed), setup.parameters.seed);
  const RayTracingSettings settings{
      setup.credits, view.width, view.height, p.quality.sample_places(), view.pass, p.choice.skip_empty_subspaces};
  ViewProgram program(setup, rays, settings);
  if (!view.adds) p.machine->begin_picture(view.width, view.height, p.quality.layers);
  if (!wanted()) return false;
  if (follower != nullptr) follower->begin(p.scene, setup, p.quality, p.choice);
  p.relay.to = follower != nullptr ? follower : p.choice.follower;
  p.machine->run(
      program,
      [&](Cycles) {
        if (!wanted()) program.give_up();
        return true;
      },
      Machine::Then::stay);
  p.relay.to = p.choice.follower;
  if (follower != nullptr) follower->end(now());
  return !program.was_given_up();
}

Picture RenderSession::picture(std::uint32_t taken) const {
  Picture picture = picture_of(frame_buffer(), *parts_->setup);
  if (taken == parts_->quality.sample_places()) return picture;
  const float share = static_cast<float>(parts_->quality.sample_places()) / static_cast<float>(taken);
  for (auto& pixel : picture.pixels)
    for (float& channel : pixel) channel *= share;
  return picture;
}

std::vector<Layer> RenderSession::layers() const {
  return layers_of(frame_buffer(), *parts_->setup);
}

const FrameBuffer& RenderSession::frame_buffer() const {
  return parts_->machine->frame_buffer();
}

const Machine& RenderSession::machine() const {
  return *parts_->machine;
}

const RenderSetup& RenderSession::setup() const {
  return parts_->setup.value();
}

const Solution& RenderSession::solution() const {
  return parts_->solved.value();
}

double RenderSession::radiance_per_quantum() const {
  return parts_->setup->radiance_per_quantum();
}

Cycles RenderSession::now() const {
  return parts_->machine->figures().now;
}

RenderResult render(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                    const RenderFiles& files, const std::filesystem::path& pe_image,
                    const std::function<bool(const RenderProgress&)>& progress) {
  return RenderSession(scene, camera, quality, machine, files, pe_image, progress).run(Machine::Then::end);
}

}  // namespace torolux
