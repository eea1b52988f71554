// SPDX-License-Identifier: MIT
// Makes a few records at a time, from tiles before points. Then messages leave for the host: points that are done, a
// request for credits, or those that are too many.
#include "firmware/pe/work.hpp"

#include "firmware/pe/pe.hpp"

namespace torolux::pe {
namespace {

/// Records made before the PE looks for what has come: few, so that others do not wait for it.
constexpr std::uint32_t kRecordsAtATime = 4;

}  // namespace

bool has_work(const Pe& pe) {
  return pe.expansion.active || pe.points.waiting > 0 || pe.tiles.held > 0;
}

bool can_work(const Pe& pe) {
  return pe.credits.in_hand > 0 && has_work(pe);
}

void work(Pe& pe, Niu& niu) {
  if (pe.tiles.held > 0) {
    make_rays(pe, niu, kRecordsAtATime);
  } else {
    expand_points(pe, niu, kRecordsAtATime);
  }
}

void report_work(Pe& pe, Niu& niu) {
  if (pe.done.points > 0) {
    niu.send(protocol::MessageKind::work_done, pe.done);
    pe.done = {};
  }
  Credits& credits = pe.credits;
  const bool works = has_work(pe);
  if (!works && credits.homewards) {
    if (credits.in_hand > 0) pe.results.add_credits(niu, credits.in_hand);
    credits.in_hand = 0;
  } else if (works && credits.in_hand == 0 && !credits.asked) {
    niu.send(protocol::MessageKind::need);
    credits.asked = true;
  } else if (credits.in_hand >= pe.scene.layout.credits_kept + Results::kManyCredits) {
    pe.results.add_credits(niu, credits.in_hand - pe.scene.layout.credits_kept);
    credits.in_hand = pe.scene.layout.credits_kept;
  }
}

}  // namespace torolux::pe
