// SPDX-License-Identifier: MIT
// The ray tracing stage where pixels have samples as they need them: passes over the picture, and between two of them
// the sums are read back, from which the host chooses what the next one takes.
#pragma once

#include <memory>

#include "host_tools/stages/report_phase.hpp"
#include "host_tools/stages/sample_plan.hpp"
#include "host_tools/stages/tile_phase.hpp"

namespace torolux {

class AdaptivePhase : public RayPhase {
 public:
  /// camera: with as many samples as the stage's stores.
  AdaptivePhase(unsigned pes, const RayTracingSettings& settings, const protocol::CameraView& camera);

  void start(HostPort& port) override;
  void on_message(HostPort& port, PeNumber source, protocol::MessageKind kind,
                  std::span<const std::byte> contents) override;
  void on_pixels(HostPort& port, const FrameRead& read, std::span<const PixelSums> sums) override;
  bool done() const override {
    return plan_.finished() || (given_up_ && (phase_ ? phase_->done() : answered_ == asked_));
  }
  const char* waiting_for() const override;
  void save(SnapshotWriter& archive) override;
  void restore(SnapshotReader& archive) override;

  std::uint64_t made() const override { return made_ + (tracing() ? tracer().made() : 0); }
  /// How many there will be is known at the end alone: as many as have been made, and what is left of the pass.
  std::uint64_t count() const override { return made_ + (tracing() ? tracer().count() : 0); }
  std::uint64_t sent() const override { return sent_ + (tracing() ? tracer().sent() : 0); }
  std::uint64_t credits_home() const override { return tracing() ? tracer().credits_home() : settings_.credits; }
  void give_up() override {
    given_up_ = true;
    if (tracing()) static_cast<RayPhase&>(*phase_).give_up();
  }
  /// So far; a pixel has all samples of a pass once its tile has been made.
  const SampleCounts& samples() const { return samples_; }

 private:
  enum class Step : std::uint8_t { trace, report, read };

  bool tracing() const { return step_ == Step::trace && phase_ != nullptr; }
  const RayPhase& tracer() const { return static_cast<const RayPhase&>(*phase_); }
  std::unique_ptr<Phase> phase_for(Step step);
  void enter(HostPort& port, Step step);
  void go_on(HostPort& port);
  void read_more(HostPort& port);
  void note_finished(const protocol::Tile& tile);
  template <class Archive>
  void archive(Archive& archive) {
    archive(step_, samples_, made_, sent_, asked_, answered_);
  }

  unsigned pes_;
  RayTracingSettings settings_;
  protocol::CameraView camera_;
  SamplePlan plan_;
  SampleCounts samples_;
  Step step_ = Step::trace;
  std::unique_ptr<Phase> phase_;  ///< of the steps trace and report
  std::vector<FrameRead> reads_;  ///< of the step read
  std::uint64_t asked_ = 0, answered_ = 0;
  std::uint64_t made_ = 0, sent_ = 0;  ///< in passes before the present one
  bool given_up_ = false;
};

}  // namespace torolux
