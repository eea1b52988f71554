// SPDX-License-Identifier: MIT
// The machines of a render, drafts' and the picture's: what each is made of, and how one runs after the other.
#pragma once

#include <functional>

#include "host_tools/checkpoint/checkpoint_file.hpp"
#include "host_tools/checkpoint/keeper.hpp"
#include "host_tools/render/course.hpp"
#include "host_tools/render/drafts.hpp"
#include "host_tools/setup/setup.hpp"
#include "host_tools/stages/render_program.hpp"

namespace torolux {

MachineSetup machine_setup(const RenderSetup& setup, const Quality& quality, const MachineChoice& choice);
/// Throws InputError where it does not fit.
RenderSetup fitting_setup(const Scene& scene, const Camera& camera, const Quality& quality,
                          const MachineChoice& machine, const Image& image, const std::vector<Split>& splits);
/// setup: outlives the job.
RenderJob job_of(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                 const RenderSetup& setup, bool radiosity_only);

/// Runs one machine of a render after the other, and tells how far they all are. What it refers to outlives it.
class Watch {
 public:
  /// keeper: null where no checkpoints are kept. from: a checkpoint, from which the first machine goes on, or null;
  /// drafts: of that.
  Watch(Course course, Drafts& drafts, CheckpointKeeper* keeper, CheckpointReader* from,
        const std::function<bool(const RenderProgress&)>& progress);
  SnapshotKeeper* keeper() const { return keeper_; }
  /// As fitting_setup, of the machine that is next, with the drafts' splits. Ctrl-C does not end it where drafts are
  /// done and can be saved: that machine does so.
  RenderSetup next_setup(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                         const Image& image) const;

  void run(Machine& machine, RenderProgram& program, const RenderSetup& setup, bool draft,
           Machine::Then then = Machine::Then::end);

 private:
  Course course_;
  Drafts& drafts_;
  CheckpointKeeper* keeper_;
  CheckpointReader* from_;
  const std::function<bool(const RenderProgress&)>& progress_;
};

}  // namespace torolux
