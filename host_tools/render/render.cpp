// SPDX-License-Identifier: MIT
// One render from scene to picture. See render.hpp.
#include "host_tools/render/render.hpp"

#include <chrono>
#include <utility>

#include "emulator/errors.hpp"
#include "host_tools/render/setup.hpp"
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
  return machine;
}

Picture picture_of(const FrameBuffer& frame_buffer, const RenderSetup& setup) {
  Picture picture;
  picture.width = frame_buffer.width;
  picture.height = frame_buffer.height;
  picture.pixels.reserve(frame_buffer.pixels.size());
  const double unit = setup.units.unit_radiance / static_cast<double>(setup.parameters.pixel_scale);
  for (const auto& pixel : frame_buffer.pixels) {
    picture.pixels.push_back({static_cast<float>(static_cast<double>(pixel[0]) * unit),
                              static_cast<float>(static_cast<double>(pixel[1]) * unit),
                              static_cast<float>(static_cast<double>(pixel[2]) * unit)});
  }
  return picture;
}

RenderFigures figures_of(const RenderProgram& program, const Machine& machine, const RenderSetup& setup) {
  RenderFigures figures;
  const StageTimes& times = program.times();
  figures.radiosity_cycles = times.radiosity - times.loaded;
  figures.load_cycles = times.loaded + (times.loaded_again - times.radiosity);
  figures.ray_tracing_cycles = times.ray_tracing - times.loaded_again;
  figures.machine = machine.figures();
  figures.shots = program.shots();
  figures.rays = program.rays();
  figures.credits_total = setup.credits;
  figures.credits_home = program.credits_home();
  figures.local_memory_bytes = *setup.memory;
  figures.subspaces = setup.placement.grid.cells;
  return figures;
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

}  // namespace

RenderResult render(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                    const RenderFiles& files, const std::filesystem::path& pe_image,
                    const std::function<bool(const RenderProgress&)>& progress) {
  const Image image = load_image(pe_image);
  const RenderSetup setup = make_setup(scene, quality, machine, image);
  if (!setup.memory) throw InputError(setup.need.refusal(machine.pe_memory.value_or(protocol::kLargestLocalMemory)));
  RenderJob job{
      scene,
      setup,
      radiosity_settings(scene, setup, quality),
      CameraRays(camera, setup.mesh.space, quality.width, quality.height, quality.samples, setup.parameters.seed),
      {setup.credits, quality.width, quality.height, quality.samples, machine.skip_empty_subspaces},
      std::nullopt};
  const RadiosityOrigin origin = radiosity_origin(scene, quality, setup.mesh);
  if (files.radiosity) {
    job.solution = load_radiosity(*files.radiosity, origin, setup.mesh);
    check_balance(*files.radiosity, scene, setup, *job.solution);
  }

  RenderProgram program(std::move(job));
  Machine torolux(machine_setup(setup, quality, machine), image);
  const auto begin = std::chrono::steady_clock::now();
  torolux.run(program, [&](Cycles now) { return !progress || progress(program.progress(now)); });

  RenderResult result;
  result.notes = setup.notes;
  result.figures = figures_of(program, torolux, setup);
  result.figures.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!program.finished()) return result;  // stopped by `progress`
  result.figures.energy = balance(scene, setup.mesh, setup.units, *program.solution());
  if (!files.radiosity) result.figures.radiosity_records = program.solution()->tally.rays;
  if (files.save_radiosity) save_radiosity(*files.save_radiosity, origin, *program.solution());
  result.picture = picture_of(torolux.frame_buffer(), setup);
  return result;
}

}  // namespace torolux
