// SPDX-License-Identifier: MIT
// A render whose machine stays when its picture is there, so that the solved scene can be looked at from elsewhere. In
// virtual time nothing passes between two views, however long somebody thinks.
#pragma once

#include <functional>
#include <memory>

#include "host_tools/render/render.hpp"
#include "host_tools/setup/setup.hpp"
#include "host_tools/stages/ray_phase.hpp"

namespace torolux {

class RecordFollower;  // host_tools/setup/record_follower.hpp

/// One pass over a picture of the solved scene.
struct View {
  Camera camera;
  std::uint32_t width = 0, height = 0;  ///< [pixels]
  SamplePass pass;                      ///< of the Quality's samples
  bool adds = false;  ///< to what the passes before it have left, which were of the same camera and size
};

class RenderSession {
 public:
  /// As of render(). All that is referred to outlives this.
  RenderSession(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                const RenderFiles& files, const std::filesystem::path& pe_image,
                const std::function<bool(const RenderProgress&)>& progress);
  ~RenderSession();

  /// As render(), once; stays: views may follow. The result is the same.
  RenderResult run(Machine::Then then);

  /// After a run that stays. wanted: asked some ten times a second and before each pass; false: the view is given up,
  /// and all its light comes home. Returns whether it is whole. Throws InputError for a camera that looks nowhere,
  /// MachineFailure.
  /// follower (null: nobody): told of the view's records, and before it what the view is of.
  bool view(const View& view, const std::function<bool()>& wanted, RecordFollower* follower = nullptr);
  /// Of what has been added so far: taken is the number of samples of each pixel. The sums of all samples: those of
  /// render() with that camera.
  Picture picture(std::uint32_t taken) const;
  std::vector<Layer> layers() const;  ///< once all samples are taken
  const FrameBuffer& frame_buffer() const;
  Cycles now() const;  ///< virtual time at the end of the last run or view
  const Machine& machine() const;
  const RenderSetup& setup() const;
  const Solution& solution() const;     ///< of the first run, which has come to its end
  double radiance_per_quantum() const;  ///< of the frame buffer's sums, where all samples are taken

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace torolux
