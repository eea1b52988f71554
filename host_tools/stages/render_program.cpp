// SPDX-License-Identifier: MIT
// Makes one phase after the other, hands it the PEs' messages, and takes what it leaves into the next. Also what a
// caller asks meanwhile: progress, credits at home, kinds of records.
#include "host_tools/stages/render_program.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/layout/stage_image.hpp"
#include "host_tools/solution/foreseen_flux.hpp"
#include "host_tools/stages/adaptive_phase.hpp"
#include "host_tools/stages/load_phase.hpp"
#include "host_tools/stages/radiosity_phase.hpp"
#include "host_tools/stages/read_phase.hpp"
#include "host_tools/stages/report_phase.hpp"
#include "host_tools/stages/tile_phase.hpp"

namespace torolux {

using protocol::Stage;

RenderProgram::RenderProgram(RenderJob job)
    : job_(std::move(job)),
      given_(job_.solution.has_value()),
      step_(given_ ? Step::load_ray_tracing : Step::load_radiosity) {}
RenderProgram::~RenderProgram() = default;

void RenderProgram::start(HostPort& port) {
  port.begin_stage(name_of(step_));
  port.work(HostWork::filter_entry, job_.rays.samples().distances().size());
  enter(port, step_);
}

std::string_view RenderProgram::name_of(Step step) const {
  switch (step) {
    case Step::load_radiosity:
      return "load";
    case Step::radiosity:
      return "radiosity";
    case Step::read:
      return "read";
    case Step::load_ray_tracing:
      return given_ ? "load" : "load_again";
    case Step::ray_tracing:
    case Step::report:
      return "ray_tracing";
    case Step::finished:
      break;
  }
  return "";
}

void RenderProgram::on_message(HostPort& port, PeNumber source, std::uint16_t kind,
                               std::span<const std::byte> contents) {
  const auto message = static_cast<protocol::MessageKind>(kind);
  if (!phase_) unexpected(source, message, "nothing is left to do");
  phase_->on_message(port, source, message, contents);
  if (phase_->done()) leave(port);
}

void RenderProgram::on_pixels(HostPort& port, const FrameRead& read, std::span<const PixelSums> sums) {
  if (!phase_) throw MachineFailure("the frame buffer controller sent pixels, and nothing is left to do");
  phase_->on_pixels(port, read, sums);
  if (phase_->done()) leave(port);
}

void RenderProgram::enter(HostPort& port, Step step) {
  if (step != Step::finished && name_of(step) != name_of(step_)) port.begin_stage(name_of(step));
  step_ = step;
  phase_ = phase_for(step);
  if (!phase_) return;
  charge(port, step);
  phase_->start(port);
  if (phase_->done()) leave(port);
}

/// What the host computes before a step begins.
void RenderProgram::charge(HostPort& port, Step step) const {
  if (step == Step::load_radiosity) {
    port.work(HostWork::hemicube_entry, protocol::hemicube_weights(job_.setup.parameters.hemicube));
  } else if (step == Step::load_ray_tracing) {
    port.work(HostWork::irradiance_triangle, irradiance_.triangles.size() + irradiance_.filtered);
    port.work(HostWork::irradiance_fit, irradiance_.fits);
  }
}

std::unique_ptr<Phase> RenderProgram::phase_for(Step step) {
  const RenderSetup& setup = job_.setup;
  switch (step) {
    case Step::load_radiosity:
      return loading(Stage::radiosity);
    case Step::radiosity:
      return std::make_unique<RadiosityPhase>(job_.radiosity);
    case Step::read: {
      std::vector<protocol::StageLayout> layouts;
      for (unsigned pe = 0; pe < setup.placement.torus.pes(); ++pe) {
        layouts.push_back(lay_out(setup.mesh, setup.placement, static_cast<PeNumber>(pe), Stage::radiosity,
                                  setup.parameters, setup.map)
                              .layout);
      }
      return std::make_unique<ReadPhase>(setup.mesh, setup.placement, std::move(layouts));
    }
    case Step::load_ray_tracing: {
      // The plan is a matter of the mesh, and like that not charged (docs/costs.md): it is made here, as late as it can
      // be, to spare memory.
      const PictureLight light = picture_light(setup.mesh, *job_.solution, setup.parameters.emitters > 0,
                                               setup.parameters.gathers_emission != 0);
      irradiance_ = make_vertex_irradiance(IrradiancePlan(setup.mesh), light.flux, setup.units.watts_per_quantum,
                                           setup.units.unit_radiance, light.of_record);
      return loading(Stage::ray_tracing);
    }
    case Step::ray_tracing:
      if (is_adaptive())
        return std::make_unique<AdaptivePhase>(setup.placement.torus.pes(), job_.ray_tracing, job_.rays.view());
      if (setup.parameters.pixel_samples > 0)
        return std::make_unique<TilePhase>(setup.placement.torus.pes(), job_.ray_tracing);
      return std::make_unique<RayTracingPhase>(setup.ray_placement, job_.rays, job_.ray_tracing);
    case Step::report:
      return std::make_unique<ReportPhase>(setup.placement.torus.pes());
    case Step::finished:
      break;
  }
  return nullptr;
}

std::unique_ptr<Phase> RenderProgram::loading(Stage stage) {
  const RenderSetup& setup = job_.setup;
  const auto layout_at = [this, &setup, stage](const Placement& placement, PeNumber pe) {
    PeLayout layout = lay_out(setup.mesh, placement, pe, stage, setup.parameters, setup.map);
    layout.layout.view = job_.rays.view();
    return layout;
  };
  const auto image_at = [this, &setup, stage, layout_at](const Placement& placement, PeNumber pe,
                                                         const PeLoad* common) {
    const PeLayout layout = layout_at(placement, pe);
    return stage == Stage::radiosity
               ? radiosity_image(job_.scene, setup.mesh, placement, pe, setup.units, layout, common)
               : ray_tracing_image(job_.scene, setup.mesh, placement, pe, setup.units, irradiance_, layout,
                                   {job_.rays.samples().places(), job_.rays.samples().distances()}, common);
  };
  const Placement& placement = setup.placement_of(stage);
  Loads loads;
  loads.layout = [&placement, layout_at](PeNumber pe) { return layout_at(placement, pe).layout; };
  if (setup.load_together) {
    const Placement common = placement.with_nobody();
    const auto nobody = static_cast<PeNumber>(placement.torus.pes());
    loads.common =
        std::make_shared<const PeLoad>(PeLoad{layout_at(common, nobody).layout, image_at(common, nobody, nullptr)});
  }
  loads.image = [&placement, image_at, common = loads.common](PeNumber pe) {
    return image_at(placement, pe, common.get());
  };
  return std::make_unique<LoadPhase>(placement.torus.pes(), std::move(loads));
}

void RenderProgram::leave(HostPort& port) {
  const Cycles now = port.now();
  switch (step_) {
    case Step::load_radiosity:
      times_.loaded = now;
      enter(port, Step::radiosity);
      break;
    case Step::radiosity: {
      const auto& radiosity = static_cast<const RadiosityPhase&>(*phase_);
      rounds_ = radiosity.rounds();
      port.note(HostGauge::unshot, 0);  // it is told of the radiosity stage alone
      shots_ = radiosity.shots();
      emitted_shot_ = radiosity.emitted_shot();
      reflected_shot_ = radiosity.reflected_shot();
      sky_shot_ = radiosity.sky_shot();
      times_.radiosity = now;
      enter(port, Step::read);
      break;
    }
    case Step::read:
      radiosity_visits_ = static_cast<const ReadPhase&>(*phase_).visits();
      job_.solution = static_cast<ReadPhase&>(*phase_).take_solution();
      job_.solution->emitted_shot = emitted_shot_;
      job_.solution->reflected_shot = reflected_shot_;
      job_.solution->sky_shot = sky_shot_;
      job_.solution->shots = shots_;
      times_.read = now;
      enter(port, job_.radiosity_only ? Step::finished : Step::load_ray_tracing);
      break;
    case Step::load_ray_tracing:
      times_.loaded_again = now;
      enter(port, Step::ray_tracing);
      break;
    case Step::ray_tracing:
      rays_ = static_cast<const RayPhase&>(*phase_).sent();
      samples_ = samples();
      enter(port, Step::report);
      break;
    case Step::report:
      ray_visits_ = static_cast<const ReportPhase&>(*phase_).visits();
      times_.ray_tracing = now;
      enter(port, Step::finished);
      break;
    case Step::finished:
      break;
  }
}

const char* RenderProgram::waiting_for() const {
  return phase_ ? phase_->waiting_for() : "nothing";
}

std::uint64_t RenderProgram::credits_home() const {
  if (step_ == Step::radiosity) return static_cast<const RadiosityPhase&>(*phase_).credits_home();
  if (step_ == Step::ray_tracing) return static_cast<const RayPhase&>(*phase_).credits_home();
  return job_.setup.credits;
}

const SampleCounts& RenderProgram::samples() const {
  if (step_ == Step::ray_tracing && is_adaptive()) return static_cast<const AdaptivePhase&>(*phase_).samples();
  return samples_;
}

std::uint64_t RenderProgram::rounds_ended() const {
  if (step_ != Step::radiosity) return rounds_.size();
  return static_cast<const RadiosityPhase&>(*phase_).rounds().size() - 1;
}

template <class Archive>
void RenderProgram::archive(Archive& archive) {
  archive.section("program");
  archive(step_, job_.solution, times_, rounds_, radiosity_visits_, ray_visits_, shots_, rays_, emitted_shot_,
          reflected_shot_, sky_shot_, samples_);
}

void RenderProgram::save(SnapshotWriter& archive) {
  this->archive(archive);
  if (phase_) phase_->save(archive);
}

void RenderProgram::restore(SnapshotReader& archive) {
  this->archive(archive);
  const bool lacks_light = step_ > Step::read && !job_.solution;
  if (step_ > Step::finished || lacks_light) refuse_snapshot("the host's program is nowhere");
  phase_ = phase_for(step_);
  if (phase_) phase_->restore(archive);
}

RenderProgress RenderProgram::progress(Cycles now) const {
  RenderProgress progress{};
  progress.stage = RenderStage::load;
  progress.virtual_time = now;
  progress.credits_total = job_.setup.credits;
  progress.credits_home = credits_home();
  progress.radiosity_records = std::max(1.0, job_.radiosity.shot_records + job_.radiosity.gather_records);
  // `enough_unshot` is the user's fraction of what was emitted; before the first selection nothing is shot.
  progress.unshot_fraction = 1;
  if (step_ == Step::load_radiosity || step_ == Step::load_ray_tracing) {
    progress.fraction = static_cast<const LoadPhase&>(*phase_).fraction();
  } else if (step_ == Step::radiosity) {
    const auto& radiosity = static_cast<const RadiosityPhase&>(*phase_);
    progress.stage = RenderStage::radiosity;
    const double target = std::max(1.0, static_cast<double>(job_.radiosity.enough_unshot));
    const double start = std::max(target, job_.radiosity.emitted);
    if (radiosity.shots() > 0) progress.unshot_fraction = static_cast<double>(radiosity.unshot()) / start;
    const double now_unshot = std::clamp(progress.unshot_fraction * start, target, start);
    // Unshot flux falls about exponentially.
    const double shot = start > target ? std::log(start / now_unshot) / std::log(start / target) : 0;
    const double gathered = radiosity.gathered() * job_.radiosity.gather_records;
    progress.fraction = (shot * job_.radiosity.shot_records + gathered) / progress.radiosity_records;
  } else if (step_ == Step::ray_tracing) {
    const auto& rays = static_cast<const RayPhase&>(*phase_);
    progress.stage = RenderStage::ray_tracing;
    progress.unshot_fraction = 0;
    progress.fraction = static_cast<double>(rays.made()) / static_cast<double>(rays.count());
  } else if (step_ == Step::report || step_ == Step::finished) {
    progress.stage = RenderStage::ray_tracing;
    progress.fraction = 1;
  }
  return progress;
}

}  // namespace torolux
