// SPDX-License-Identifier: MIT
// Looks at the machine from time to time.
#include "host_tools/growing_picture/growing_picture.hpp"

#include <algorithm>

namespace torolux {
namespace {

constexpr double kViewerSeconds = 0.25;
/// A look at a large picture takes time of the run's thread: at most a fiftieth of it.
constexpr double kShareOfLooks = 0.02;

/// What a viewer shows before the first ray.
std::shared_ptr<const PictureState> black(const Quality& quality) {
  auto state = std::make_shared<PictureState>();
  const std::size_t pixels = std::size_t{quality.width} * quality.height;
  state->picture = {quality.width, quality.height, std::vector<std::array<float, 3>>(pixels)};
  for (const LayerName& name : layers_in(quality.layers)) {
    Layer layer{name.plane, {}, {}};
    const bool numbers = name.plane == protocol::Plane::elements || name.plane == protocol::Plane::owner ||
                         name.plane == protocol::Plane::cost;
    if (numbers)
      layer.numbers.assign(pixels, name.plane == protocol::Plane::cost ? 0 : kNoNumber);
    else
      layer.values.assign(pixels, {});
    state->layers.push_back(std::move(layer));
  }
  return state;
}

}  // namespace

GrowingPicture::GrowingPicture(const GrowingPictureChoice& choice, const std::string& title, const Quality& quality,
                               const ToneMapping& tone, const std::vector<std::filesystem::path>& outputs) {
  if (choice.preview_seconds) {
    preview_due_ = Due{*choice.preview_seconds};
    preview_ = std::make_unique<PreviewWriter>(outputs, tone);
  }
  if (choice.viewer) {
    viewer_due_ = Due{kViewerSeconds};
    sender_ = std::make_unique<PictureSender>(*choice.viewer, title, black(quality));
  }
}

void GrowingPicture::show(const RenderProgress& progress) {
  if (progress.running == nullptr || progress.running->draft || progress.stage != RenderStage::ray_tracing) return;
  const Clock::time_point now = Clock::now();
  const auto due = [&](std::optional<Due>& what) {
    if (!what || !what->now(now) || !Due{taking_seconds_ / kShareOfLooks, what->last}.now(now)) return false;
    what->last = now;
    return true;
  };
  const bool for_preview = due(preview_due_), for_viewer = due(viewer_due_);
  if (!for_preview && !for_viewer) return;
  const auto state = std::make_shared<const PictureState>(picture_state(*progress.running));
  taking_seconds_ = std::chrono::duration<double>(Clock::now() - now).count();
  if (for_preview) preview_->put(state);
  if (for_viewer) sender_->put(state);
}

std::string GrowingPicture::finish(const Picture& picture, const std::vector<Layer>& layers) {
  std::string note;
  if (preview_) {
    if (const std::string failure = preview_->stop(); !failure.empty()) note = "a preview was not written: " + failure;
  }
  if (sender_ && !sender_->finish(std::make_shared<const PictureState>(PictureState{picture, layers})))
    note +=
        std::string(note.empty() ? "" : "; ") + "no viewer at the address of --display-server took the whole picture";
  return note;
}

}  // namespace torolux
