// SPDX-License-Identifier: MIT
// Weights of the stages, and their sums.
#include "host_tools/render/course.hpp"

#include <algorithm>

#include "host_tools/setup/setup.hpp"

namespace torolux {
namespace {

/// Records of a radiosity stage for each of emission; of a draft, which ends when 5 % is unshot. Seen in the Cornell
/// box: 4.3 and 2.9.
constexpr double kRecordsOfEmission = 4;
constexpr double kDraftRecordsOfEmission = 3;
/// A camera ray, with its shadow ray, takes as long as so many records: 9,300 cycles against 4,600 there.
constexpr double kRecordsOfRay = 2;

}  // namespace

Course::Course(const Quality& quality, bool radiosity_given)
    : of_draft_(kDraftRecordsOfEmission * draft_of(quality).emission_records),
      of_radiosity_(radiosity_given ? 0 : kRecordsOfEmission * quality.emission_records),
      of_rays_(kRecordsOfRay * quality.width * quality.height * quality.samples),
      drafts_left_(quality.refine > 0 && !radiosity_given ? kDrafts : 0),
      radiosity_over_(radiosity_given) {
  all_ = drafts_left_ * of_draft_ + of_radiosity_ + of_rays_;
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
  double done = before_;
  if (progress.stage == RenderStage::radiosity) {
    done += fraction * (is_draft_ ? of_draft_ : of_radiosity_);
    radiosity_over_ = radiosity_over_ || !is_draft_;
  } else if (progress.stage == RenderStage::ray_tracing) {
    done += is_draft_ ? of_draft_ : of_radiosity_ + fraction * of_rays_;
  } else if (radiosity_over_) {  // the second load
    done += of_radiosity_;
  }
  share_ = std::max(share_, std::min(done / all_, 1.0));
  return share_;
}

}  // namespace torolux
