// SPDX-License-Identifier: MIT
// One render from scene to picture, and views of the solved scene after it.
#include "host_tools/render/render.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "emulator/errors.hpp"
#include "firmware/protocol/random.hpp"
#include "host_tools/irradiance/refine.hpp"
#include "host_tools/render/course.hpp"
#include "host_tools/render/frame_layers.hpp"
#include "host_tools/render/running_render.hpp"
#include "host_tools/render/session.hpp"
#include "host_tools/setup/advice.hpp"
#include "host_tools/setup/record_follower.hpp"
#include "host_tools/setup/setup.hpp"
#include "host_tools/solution/ply_file.hpp"
#include "host_tools/solution/radiosity_file.hpp"
#include "host_tools/stages/render_program.hpp"
#include "host_tools/stages/view_program.hpp"

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
  machine.progress_seconds = choice.progress_seconds;
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
          {setup.credits,
           quality.width,
           quality.height,
           quality.samples,
           {0, quality.samples, 1},
           machine.skip_empty_subspaces},
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

/// Runs one machine of a render after the other, and tells how far they all are.
struct Watch {
  Course& course;
  const std::function<bool(const RenderProgress&)>& progress;

  void run(Machine& machine, RenderProgram& program, const RenderSetup& setup, bool draft,
           Machine::Then then = Machine::Then::end) const {
    course.begin_machine();
    const RunningRender running{machine, program, setup, draft};
    const auto tell = [&](Cycles now) {
      if (!progress) return true;
      RenderProgress present = program.progress(now);
      present.running = &running;
      present.overall = course.share(present);
      return progress(present);
    };
    machine.run(program, tell, then);
  }
};

/// Where the mesh needs more elements. Absent: stopped by `progress`.
std::optional<std::vector<Split>> draft_splits(const Scene& scene, const Camera& camera, const Quality& full,
                                               const MachineChoice& choice, const Image& image, const Watch& watch,
                                               RenderFigures& figures) {
  const Quality quality = draft_of(full);
  std::vector<Split> splits;
  std::uint64_t more = 0;
  for (std::uint32_t round = 0; round < kDraftRounds; ++round) {
    RenderSetup setup = fitting_setup(scene, camera, quality, choice, image, splits);
    DraftLight light;
    for (std::uint32_t half = 0; half < light.flux.size(); ++half) {
      setup.parameters.seed = protocol::hash_combine(machine_seed(full.seed), 2 * round + half);
      RenderProgram program(job_of(scene, camera, quality, choice, setup, true));
      Machine torolux(machine_setup(setup, quality, choice), image);
      watch.run(torolux, program, setup, true);
      if (!program.finished()) return std::nullopt;
      figures.draft_cycles += program.times().read;
      figures.draft_records += program.solution()->tally.rays;
      light.flux[half] = incident_flux(*program.solution(), full.shadow_rays);
      light.of_record = flux_of_record(*program.solution());
    }
    if (round == 0) more = static_cast<std::uint64_t>(full.refine * setup.mesh.elements) / kDraftRounds;
    std::vector<Split> chosen = choose_splits(setup.mesh, scene, light, more);
    std::vector<Split> all;
    std::set_union(splits.begin(), splits.end(), chosen.begin(), chosen.end(), std::back_inserter(all));
    splits = std::move(all);
  }
  return splits;
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

  std::optional<std::vector<Split>> splits_for(const std::optional<SavedRadiosity>& saved, const Watch& watch,
                                               RenderFigures& figures) const {
    if (saved) return saved->splits;
    if (quality.refine <= 0) return std::vector<Split>{};
    return draft_splits(scene, camera, quality, choice, image, watch, figures);
  }

  MachineSetup of_picture(Machine::Then then) {
    MachineSetup machine_setup = torolux::machine_setup(*setup, quality, choice);
    machine_setup.watcher = choice.watcher;
    machine_setup.record_watcher = choice.follower;
    relay.to = choice.follower;
    if (then == Machine::Then::stay) machine_setup.record_watcher = &relay;
    machine_setup.pacer = choice.pacer;
    machine_setup.hop_watcher = choice.hop_watcher;
    return machine_setup;
  }

  void write_files(const RadiosityOrigin& origin, const std::vector<Split>& splits, const Solution& solution) const {
    if (files.save_radiosity) save_radiosity(*files.save_radiosity, origin, splits, solution);
    if (!files.save_mesh) return;
    const VertexIrradiance irradiance = make_vertex_irradiance(
        setup->mesh, incident_flux(solution, false), setup->units.watts_per_quantum, setup->units.unit_radiance);
    save_ply(*files.save_mesh, scene, setup->mesh, setup->units, irradiance);
  }

  void take_picture(RenderResult& result) const {
    const FrameBuffer& sums = machine->frame_buffer();
    result.figures.picture_sha256 = digest_of(sums, protocol::Plane::colour);
    for (const LayerName& layer : layers_in(quality.layers))
      result.figures.layers_sha256.push_back(digest_of(sums, layer.plane));
    result.picture = picture_of(sums, *setup);
    result.layers = layers_of(sums, *setup);
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
  Course course(p.quality, p.files.radiosity.has_value());
  const Watch watch{course, p.progress};
  std::optional<SavedRadiosity> saved;
  if (p.files.radiosity) {
    saved = read_radiosity(*p.files.radiosity);
    check_radiosity(*saved, p.scene, p.quality);
  }
  const auto splits = p.splits_for(saved, watch, result.figures);
  if (!splits) return result;
  const RenderSetup& setup = p.setup.emplace(fitting_setup(p.scene, p.camera, p.quality, p.choice, p.image, *splits));
  RenderJob job = job_of(p.scene, p.camera, p.quality, p.choice, setup, false);
  const RadiosityOrigin origin = radiosity_origin(p.scene, p.quality, setup.mesh);
  if (saved) {
    job.solution = unpack_radiosity(*saved, origin, setup.mesh);
    check_balance(*p.files.radiosity, p.scene, setup, *job.solution);
  }

  RenderProgram program(std::move(job));
  if (p.choice.follower != nullptr) p.choice.follower->begin(p.scene, setup, p.quality, p.choice);
  Machine& machine = p.machine.emplace(p.of_picture(then), p.image);
  const auto run_begin = Clock::now();
  watch.run(machine, program, setup, false, then);
  result.figures.run_seconds = seconds_since(run_begin);

  result.notes = setup.notes;
  add_figures(program, machine, setup, result.figures);
  result.figures.splits = splits->size();
  result.figures.wall_seconds = seconds_since(begin);
  if (!program.finished()) return result;  // stopped by `progress`
  result.figures.energy = balance(p.scene, setup.mesh, setup.units, *program.solution());
  if (!p.files.radiosity) result.figures.radiosity_records = program.solution()->tally.rays;
  p.write_files(origin, *splits, *program.solution());
  p.take_picture(result);
  p.solved = program.take_solution();
  return result;
}

bool RenderSession::view(const View& view, const std::function<bool()>& wanted, RecordFollower* follower) {
  Parts& p = *parts_;
  const RenderSetup& setup = p.setup.value();
  const CameraRays rays(view.camera, setup.mesh.space, view.width, view.height,
                        PixelSamples(p.quality.filter, p.quality.samples, setup.parameters.seed),
                        setup.parameters.seed);
  const RayTracingSettings settings{setup.credits,     view.width, view.height,
                                    p.quality.samples, view.pass,  p.choice.skip_empty_subspaces};
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
  if (taken == parts_->quality.samples) return picture;
  const float share = static_cast<float>(parts_->quality.samples) / static_cast<float>(taken);
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
