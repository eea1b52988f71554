// SPDX-License-Identifier: MIT
// Weights of the stages, and their sums.
#include "host_tools/render/course.hpp"

#include <algorithm>

#include "host_tools/setup/setup.hpp"
#include "host_tools/stages/radiosity_settings.hpp"

namespace torolux {
namespace {

/// A draft ends when 5 % is unshot: 2.9 records of the Cornell box for each of emission, in place of 4.3.
constexpr double kOfDraft = 0.7;
/// A camera ray, with its shadow ray, takes as long as so many records: 9,300 cycles against 4,600 there.
constexpr double kRecordsOfRay = 2;

}  // namespace

Course::Course(const Quality& quality, bool radiosity_given)
    : of_draft_(kOfDraft * foretold_shot_records(draft_of(quality))),
      of_radiosity_(radiosity_given ? 0 : foretold_shot_records(quality)),
      of_rays_(kRecordsOfRay * quality.width * quality.height * quality.samples),
      drafts_left_(quality.refine > 0 && !radiosity_given ? kDrafts : 0),
      radiosity_over_(radiosity_given) {
  of_drafts_ = drafts_left_ * of_draft_;
}

void Course::begin_machine() {
  ++machines_;
  if (is_draft_) before_ += of_draft_;
  is_draft_ = drafts_left_ > 0;
  if (is_draft_) --drafts_left_;
}

void Course::skip_machines(unsigned machines) {
  for (unsigned i = 0; i < machines && drafts_left_ > 0; ++i) begin_machine();
}

double Course::share(const RenderProgress& progress) {
  const double fraction = std::clamp(progress.fraction, 0.0, 1.0);
  // Only now is it known how many rays final gathering takes.
  if (!is_draft_ && of_radiosity_ > 0 && progress.radiosity_records > 0) of_radiosity_ = progress.radiosity_records;
  double done = before_;
  if (progress.stage == RenderStage::radiosity) {
    done += fraction * (is_draft_ ? of_draft_ : of_radiosity_);
    radiosity_over_ = radiosity_over_ || !is_draft_;
  } else if (progress.stage == RenderStage::ray_tracing) {
    done += is_draft_ ? of_draft_ : of_radiosity_ + fraction * of_rays_;
  } else if (radiosity_over_) {  // the second load
    done += of_radiosity_;
  }
  share_ = std::max(share_, std::min(done / (of_drafts_ + of_radiosity_ + of_rays_), 1.0));
  return share_;
}

}  // namespace torolux
