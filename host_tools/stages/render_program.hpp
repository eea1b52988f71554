// SPDX-License-Identifier: MIT
// The host's whole program of a render: load, radiosity stage, read-out, load again, ray tracing stage.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "host_tools/camera/camera_rays.hpp"
#include "host_tools/irradiance/vertex_irradiance.hpp"
#include "host_tools/setup/setup.hpp"
#include "host_tools/solution/solution.hpp"
#include "host_tools/stages/light_program.hpp"
#include "host_tools/stages/phase.hpp"
#include "host_tools/stages/progress.hpp"
#include "host_tools/stages/radiosity_settings.hpp"
#include "host_tools/stages/ray_tracing_phase.hpp"
#include "host_tools/stages/rounds.hpp"
#include "host_tools/stages/sample_plan.hpp"

namespace torolux {

struct RenderJob {
  const Scene& scene;
  const RenderSetup& setup;
  RadiositySettings radiosity;
  CameraRays rays;
  RayTracingSettings ray_tracing;
  std::optional<Solution> solution;  ///< given: the radiosity stage is left out
  bool radiosity_only = false;       ///< ends after the read-out
};

/// When each step ended, in virtual time.
struct StageTimes {
  Cycles loaded = 0, radiosity = 0, read = 0, loaded_again = 0, ray_tracing = 0;
};

class RenderProgram : public LightProgram {
 public:
  explicit RenderProgram(RenderJob job);
  ~RenderProgram() override;

  void start(HostPort& port) override;
  void on_message(HostPort& port, PeNumber source, std::uint16_t kind, std::span<const std::byte> contents) override;
  void on_pixels(HostPort& port, const FrameRead& read, std::span<const PixelSums> sums) override;
  bool finished() const override { return step_ == Step::finished; }
  const char* waiting_for() const override;

  RenderProgress progress(Cycles now) const;
  const RenderJob& job() const { return job_; }
  const std::optional<Solution>& solution() const { return job_.solution; }  ///< after the read-out, or as given
  Solution take_solution() { return *std::move(job_.solution); }             ///< which is there
  const StageTimes& times() const { return times_; }
  std::uint64_t shots() const { return shots_; }
  /// By path segments of the stage; zeros before it has ended.
  const VisitSums& radiosity_visits() const { return radiosity_visits_; }
  const VisitSums& ray_visits() const { return ray_visits_; }
  const std::vector<RoundFigures>& rounds() const { return rounds_; }  ///< once the radiosity stage has ended
  std::uint64_t rays() const { return rays_; }
  /// Of each pixel, as far as they have been made; empty: all have the same.
  const SampleCounts& samples() const;
  std::uint64_t credits_home() const;
  std::uint64_t rounds_ended() const;

  /// Between two messages.
  void save(SnapshotWriter& archive) override;
  /// Instead of the start: it goes on from what the program of an equal job has saved. Throws InputError.
  void restore(SnapshotReader& archive);

 private:
  enum class Step { load_radiosity, radiosity, read, load_ray_tracing, ray_tracing, report, finished };

  /// Of the stage of the statistics.
  std::string_view name_of(Step step) const;
  void enter(HostPort& port, Step step);
  void leave(HostPort& port);
  std::unique_ptr<Phase> phase_for(Step step);
  void charge(HostPort& port, Step step) const;
  template <class Archive>
  void archive(Archive& archive);
  std::unique_ptr<Phase> loading(protocol::Stage stage);
  bool is_adaptive() const { return job_.ray_tracing.least_samples > 0; }

  RenderJob job_;
  bool given_;  ///< the solution
  Step step_;
  std::unique_ptr<Phase> phase_;
  VertexIrradiance irradiance_;
  StageTimes times_;
  std::vector<RoundFigures> rounds_;
  VisitSums radiosity_visits_{}, ray_visits_{};
  std::uint64_t shots_ = 0;
  std::uint64_t rays_ = 0;
  SampleCounts samples_;  ///< once all are made
  protocol::Flux emitted_shot_{};
  protocol::Flux reflected_shot_{};
  protocol::Flux sky_shot_{};
};

}  // namespace torolux
