// SPDX-License-Identifier: MIT
// Selection: which of this PE's patches have most to shoot. Enters: how many, and from what flux on; leaves:
// candidates, best first.
#include <algorithm>
#include <cstddef>

#include "firmware/pe/pe.hpp"
#include "firmware/protocol/fault_fields.hpp"
#include "firmware/protocol/flux.hpp"

namespace torolux::pe {
namespace {

using protocol::Candidate;
using protocol::Candidates;
using protocol::Flux;
using protocol::ShotKind;

/// More unshot first; then lower patch number, front before back, emitted before reflected.
bool better(const Choice& a, const Choice& b) {
  if (a.unshot != b.unshot) return a.unshot > b.unshot;
  if (a.number != b.number) return a.number < b.number;
  return a.way < b.way;  // of one patch
}

std::uint32_t way_of(std::uint32_t patch, std::uint32_t side, ShotKind kind) {
  return patch * 4U + side * 2U + (kind == ShotKind::reflected ? 1U : 0U);
}

/// What a side could shoot, before reflectance.
Flux amount_of(const protocol::PatchSide& side, ShotKind kind) {
  if (kind == ShotKind::emitted) return side.emission;
  return {side.incident[0] - side.shot[0], side.incident[1] - side.shot[1], side.incident[2] - side.shot[2]};
}

/// The flux that a shot of all of it would carry.
Flux flux_of(const Scene& scene, const protocol::Patch& patch, std::uint32_t side, ShotKind kind) {
  Flux flux = amount_of(scene.patch_sides[patch.side[side]], kind);
  if (kind == ShotKind::emitted) return flux;
  for (std::size_t c = 0; c < 3; ++c) flux[c] = protocol::scale_down(flux[c], patch.reflectance[c]);
  return flux;
}

/// What each element of a side has that was not shot. Flux that comes while the round lasts must not count: when it
/// comes depends on the machine.
void note_unshot(const Scene& scene, const protocol::Patch& patch, std::uint32_t side) {
  const std::uint32_t first = scene.patch_sides[patch.side[side]].first_element;
  for (protocol::Element& element : scene.elements.subspan(first, patch.elements)) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float left = static_cast<float>(element.flux[c]) - element.shots.shot[c];
      element.shots.unshot[c] = left > 0.0F ? left : 0.0F;
    }
  }
}

/// The best so far: a heap with the worst of them on top, so that a better one takes its place.
class Best {
 public:
  Best(Choice* choices, std::uint32_t most) : choices_(choices), most_(most) {}
  void offer(const Choice& choice) {
    if (count_ < most_) {
      choices_[count_++] = choice;
      std::push_heap(choices_, choices_ + count_, better);
    } else if (better(choice, choices_[0])) {
      std::pop_heap(choices_, choices_ + count_, better);
      choices_[count_ - 1U] = choice;
      std::push_heap(choices_, choices_ + count_, better);
    }
  }
  /// Best first. Nothing can be offered afterwards.
  std::uint32_t sort() {
    std::sort_heap(choices_, choices_ + count_, better);
    return count_;
  }

 private:
  Choice* choices_;
  std::uint32_t most_;
  std::uint32_t count_ = 0;
};

void send_candidates(Pe& pe, Niu& niu, std::uint32_t count, const Flux& unshot) {
  pe.results.flush_pixels(niu);  // the buffer is theirs while there are any
  MessageBuffer& message = niu.batch();
  auto& out = *message.as<Candidates>();
  std::uint32_t sent = 0;
  do {
    out.count = std::min(count - sent, protocol::kMostCandidatesPerMessage);
    out.unshot = unshot;
    for (std::uint32_t i = 0; i < out.count; ++i) {
      const Choice& choice = pe.choices[sent + i];
      const std::uint32_t patch = choice.way / 4U;
      const std::uint32_t side = choice.way / 2U % 2U;
      const ShotKind kind = choice.way % 2U == 1U ? ShotKind::reflected : ShotKind::emitted;
      const Flux amount = amount_of(pe.scene.patch_sides[pe.scene.patches[patch].side[side]], kind);
      out.candidate[i] = {amount, choice.unshot, choice.number, patch, side, kind};
    }
    sent += out.count;
    out.last = sent == count ? 1U : 0U;
    message.header.kind = static_cast<std::uint16_t>(protocol::MessageKind::candidates);
    message.header.bytes = static_cast<std::uint32_t>(offsetof(Candidates, candidate) + out.count * sizeof(Candidate));
    niu.send_message(protocol::kHost, message.header);
  } while (sent < count);
}

}  // namespace

void select_shooters(Pe& pe, Niu& niu, const protocol::Select& select) {
  const std::int64_t threshold = select.threshold;
  if (select.count == 0 || select.count > protocol::kMostShooters) {
    niu.fail(FaultCode::outside_store, static_cast<std::uint32_t>(protocol::StoreIndex::select_count), select.count,
             protocol::kMostShooters);
  }
  Best best(pe.choices.data(), select.count);
  Flux unshot{};
  for (std::uint32_t p = 0; p < pe.scene.patches.size(); ++p) {
    const protocol::Patch& patch = pe.scene.patches[p];
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (patch.side[side] == protocol::kNoSide) continue;
      for (const ShotKind kind : {ShotKind::emitted, ShotKind::reflected}) {
        const Flux flux = flux_of(pe.scene, patch, side, kind);
        add_flux(unshot, flux);
        const std::int64_t sum = flux[0] + flux[1] + flux[2];
        if (sum <= threshold) continue;
        best.offer({sum, patch.number, way_of(p, side, kind)});
        if (kind == ShotKind::reflected) note_unshot(pe.scene, patch, side);
      }
    }
  }
  send_candidates(pe, niu, best.sort(), unshot);
}

}  // namespace torolux::pe
