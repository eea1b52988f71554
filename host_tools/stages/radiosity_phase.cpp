// SPDX-License-Identifier: MIT
// PEs' messages drive it: candidates are sorted and the first of them shoot, their points are dealt, credits granted
// and recalled. A round is over when all are home.
#include "host_tools/stages/radiosity_phase.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

#include "firmware/protocol/flux.hpp"
#include "firmware/protocol/shot_grid.hpp"

namespace torolux {
namespace {

using protocol::Candidate;
using protocol::Flux;
using protocol::MessageKind;
using protocol::ShotKind;

/// A round's shots have at least 3/4 of what the least of the last round's had, mostly: PEs need not name those with
/// less.
constexpr std::int64_t kExpectedFactor = 3;
constexpr std::int64_t kExpectedDivisor = 4;

/// Compares of a sort [n log2 n, rounded up].
std::uint64_t compares_to_sort(std::uint64_t n) {
  return n < 2 ? 0 : n * static_cast<std::uint64_t>(std::bit_width(n - 1));
}

/// The order of candidates: more unshot, then lower patch, front before back, emitted before reflected.
bool before(const Candidate& a, const Candidate& b) {
  const auto rank = [](const Candidate& c) {
    return std::tuple(-c.unshot, c.number, c.side, c.kind == ShotKind::emitted ? 0 : 1);
  };
  return rank(a) < rank(b);
}

/// All that a PE may report [quanta]: all of a scene's is 3 * 2^48, and what walls of 0.99 send back and forth, a
/// hundred times that. With it no sum overflows.
constexpr std::int64_t kMostFlux = std::int64_t{1} << 56U;

/// In the whole stage.
constexpr std::int64_t kMostShotFlux = 16 * kMostFlux;

void check_flux(PeNumber source, const char* what, std::int64_t value) {
  if (value >= 0 && value <= kMostFlux) return;
  throw MachineFailure("PE " + std::to_string(source) + " reports " + what + " of " + std::to_string(value) +
                       " quanta: 0 to " + std::to_string(kMostFlux) + " are possible");
}

void check_candidate(PeNumber source, const Candidate& candidate) {
  check_flux(source, "a candidate's unshot flux", candidate.unshot);
  for (const std::int64_t amount : candidate.amount) check_flux(source, "a candidate's amount", amount);
  if (candidate.side <= 1 && (candidate.kind == ShotKind::emitted || candidate.kind == ShotKind::reflected)) return;
  throw MachineFailure("PE " + std::to_string(source) + " offers side " + std::to_string(candidate.side) + " of kind " +
                       std::to_string(static_cast<std::uint32_t>(candidate.kind)) + ": 0 and 1 are possible for both");
}

}  // namespace

RadiosityPhase::RadiosityPhase(RadiositySettings settings)
    : settings_(std::move(settings)),
      dealer_(settings_.pes, settings_.points_travel, settings_.sky),
      credits_(settings_.credits, settings_.pes) {}

void RadiosityPhase::start(HostPort& port) {
  begin_selection(port);
}

void RadiosityPhase::begin_selection(HostPort& port) {
  state_ = State::selecting;
  rounds_.push_back({});
  rounds_.back().begin = port.now();
  select(port, std::max(settings_.least_unshot, expected_));
}

void RadiosityPhase::select(HostPort& port, std::int64_t threshold) {
  threshold_ = threshold;
  recalled_ = false;
  answers_ = 0;
  unshot_ = 0;
  candidates_.clear();
  const protocol::Select message{settings_.shooters, 0, threshold};
  port.broadcast(static_cast<std::uint16_t>(MessageKind::select), std::as_bytes(std::span(&message, 1)));
}

void RadiosityPhase::on_message(HostPort& port, PeNumber source, MessageKind kind,
                                std::span<const std::byte> contents) {
  if (state_ == State::selecting && kind == MessageKind::candidates) {
    take_candidates(port, source, contents);
  } else if (state_ == State::shooting && kind == MessageKind::credits) {
    credits_.take_home(port, source, contents);
    credits_.feed(port);
    end_round_if_over(port);
  } else if (state_ == State::shooting && kind == MessageKind::need) {
    credits_.ask(port, source);
    recall_if_due(port);
  } else if (state_ == State::shooting && kind == MessageKind::work_done) {
    take_work_done(port, source, contents_as<protocol::WorkDone>(source, contents));
    recall_if_due(port);
    end_round_if_over(port);
  } else {
    unexpected(source, kind, state_ == State::selecting ? "selecting shooters" : "shooting");
  }
}

void RadiosityPhase::take_candidates(HostPort& port, PeNumber source, std::span<const std::byte> contents) {
  const auto message = contents_as<protocol::Candidates>(source, contents, offsetof(protocol::Candidates, candidate));
  if (message.count > protocol::kMostCandidatesPerMessage ||
      contents.size() < offsetof(protocol::Candidates, candidate) + message.count * sizeof(Candidate)) {
    throw MachineFailure("PE " + std::to_string(source) + " sent candidates that are cut short");
  }
  port.work(HostWork::entry, message.count);
  for (std::uint32_t i = 0; i < message.count; ++i) {
    if (message.candidate[i].number >= settings_.reflectance.size()) {
      throw MachineFailure("PE " + std::to_string(source) + " offers a patch that does not exist");
    }
    check_candidate(source, message.candidate[i]);
    candidates_.push_back({source, message.candidate[i]});
  }
  if (message.last == 0) return;
  for (const std::int64_t unshot : message.unshot) check_flux(source, "unshot flux", unshot);
  unshot_ += message.unshot[0] + message.unshot[1] + message.unshot[2];
  if (++answers_ < settings_.pes) return;
  for (std::size_t i = 0; i < settings_.sky.size() && rounds_.size() == 1; ++i) unshot_ += settings_.sky[i].enters;
  begin_round(port);
}

std::uint64_t RadiosityPhase::most_shots() const {
  if (settings_.max_shots == 0) return settings_.shooters;
  return std::min<std::uint64_t>(settings_.shooters, settings_.max_shots - shots_);
}

void RadiosityPhase::begin_round(HostPort& port) {
  const std::uint64_t most = most_shots();
  // What PEs have not named has less than all that they have: it is needed only if those are too few.
  if (candidates_.size() < most && threshold_ > settings_.least_unshot && unshot_ > settings_.enough_unshot) {
    select(port, settings_.least_unshot);
    return;
  }
  port.work(HostWork::compare, compares_to_sort(candidates_.size()));
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Chosen& a, const Chosen& b) { return before(a.candidate, b.candidate); });
  if (candidates_.size() > most) candidates_.resize(most);
  expected_ = candidates_.size() < most ? 0 : candidates_.back().candidate.unshot / kExpectedDivisor * kExpectedFactor;
  selected_unshot_ = unshot_;
  RoundFigures& round = rounds_.back();
  round.unshot = settings_.emitted > 0 ? static_cast<double>(unshot_) / settings_.emitted : 0;
  port.note(HostGauge::unshot, round.unshot);
  round.chosen = round.last_shot_done = round.end = port.now();
  const bool sky_waits = !settings_.sky.empty() && rounds_.size() == 1;
  if (!sky_waits && (candidates_.empty() || unshot_ <= settings_.enough_unshot)) {
    candidates_.clear();
    gather_or_end(port);
    return;
  }
  round.shooters = static_cast<std::uint32_t>(candidates_.size());
  add_shots();
  if (sky_waits) add_sky_shots();
  begin_dealing(port);
}

/// The last round: of shots that look for light.
void RadiosityPhase::gather_or_end(HostPort& port) {
  gathers_ = !settings_.gatherings.empty();
  if (!gathers_) {
    state_ = State::done;
    return;
  }
  RoundFigures& round = rounds_.back();
  round.chosen = round.last_shot_done = round.end = port.now();
  round.shooters = static_cast<std::uint32_t>(settings_.gatherings.size());
  recalled_ = false;
  auto number = static_cast<std::uint32_t>(shots_);
  for (const FinalGather& of : settings_.gatherings) {
    Candidate candidate{};
    candidate.amount = {of.points, 0, 0};
    candidate.number = of.number;
    candidate.patch = of.patch;
    candidate.side = of.side;
    candidate.kind = ShotKind::gathering;
    dealer_.add(of.pe, candidate, number++, of.points);
  }
  port.work(HostWork::entry, settings_.gatherings.size());
  begin_dealing(port);
}

double RadiosityPhase::gathered() const {
  if (!gathers_ || settings_.gatherings.empty()) return 0;
  double points = 0;
  for (const FinalGather& of : settings_.gatherings) points += of.points;
  return 1 - static_cast<double>(dealer_.points_left()) / points;
}

void RadiosityPhase::begin_dealing(HostPort& port) {
  state_ = State::shooting;
  rounds_.back().pes = dealer_.begin();
  // Credits wait at the PEs until the points have been made; with those that have nothing to do, until the recall.
  const bool granted = settings_.points_travel && credits_.grant_all(port);
  dealer_.deal(port);
  for (unsigned pe = 0; pe < settings_.pes && !granted; ++pe) {
    if (dealer_.supplies(static_cast<PeNumber>(pe))) credits_.grant_share(port, static_cast<PeNumber>(pe));
  }
  credits_.note(port);
}

/// The number of a shot seeds its random numbers, so it follows the order of choice.
void RadiosityPhase::add_shots() {
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Candidate& candidate = candidates_[i].candidate;
    Flux flux = candidate.amount;
    for (std::size_t c = 0; c < 3; ++c) {
      if (candidate.kind == ShotKind::reflected) {
        flux[c] = protocol::scale_down(flux[c], settings_.reflectance[candidate.number][c]);
        reflected_shot_[c] += flux[c];
      } else {
        emitted_shot_[c] += flux[c];
      }
      if (std::max(reflected_shot_[c], emitted_shot_[c]) > kMostShotFlux) {
        throw MachineFailure("PEs offer more flux than any scene has: more than " + std::to_string(kMostShotFlux) +
                             " quanta have been shot");
      }
    }
    const std::uint32_t points = protocol::points_of_shot(candidate.kind, flux, settings_.points_per_quantum,
                                                          settings_.shot_points, settings_.emission_points);
    dealer_.add(candidates_[i].pe, candidate, static_cast<std::uint32_t>(shots_ + i), points);
  }
}

/// All of them in the first round.
void RadiosityPhase::add_sky_shots() {
  for (const SkyShot& sky : settings_.sky) {
    for (std::size_t c = 0; c < 3; ++c) sky_shot_[c] += sky.flux[c];
  }
  dealer_.add_sky();
}

void RadiosityPhase::take_work_done(HostPort& port, PeNumber source, const protocol::WorkDone& done) {
  dealer_.take_done(source, done.points);
  rounds_.back().records += done.records;
  rounds_.back().last_shot_done = port.now();
  dealer_.deal(port);
}

/// Whoever has no work keeps its credits for what is dealt to it next: each way home and out again is two messages. But
/// at the end they are all needed at home, and before it where others wait for some.
void RadiosityPhase::recall_if_due(HostPort& port) {
  const bool all_made = dealer_.all_done() && !credits_.all_home();
  if (recalled_ || !(all_made || credits_.are_short())) return;
  recalled_ = true;
  port.broadcast(static_cast<std::uint16_t>(MessageKind::recall), {});
}

void RadiosityPhase::end_round_if_over(HostPort& port) {
  if (!dealer_.all_done() || !credits_.all_home()) return;
  shots_ += candidates_.size();
  candidates_.clear();
  rounds_.back().end = port.now();
  if (gathers_) {
    state_ = State::done;
    return;
  }
  if (settings_.max_shots > 0 && shots_ >= settings_.max_shots) {
    if (!settings_.gatherings.empty()) {
      rounds_.push_back(rounds_.back());  // as much is unshot
      rounds_.back().begin = port.now();
      rounds_.back().records = 0;
    }
    gather_or_end(port);
    return;
  }
  begin_selection(port);
}

const char* RadiosityPhase::waiting_for() const {
  switch (state_) {
    case State::selecting:
      return "candidates";
    case State::shooting:
      return "shots and credits";
    case State::done:
      break;
  }
  return "nothing";
}

}  // namespace torolux
