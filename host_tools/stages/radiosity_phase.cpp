// SPDX-License-Identifier: MIT
// PEs' messages drive it: candidates are sorted and the first of them shoot, points are dealt to PEs that want work,
// credits granted and recalled. A round is over when all are home.
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

/// Points, or parts of points, that a PE has at a time: while the next one is on its way, it works on the other. When
/// no more are left than there are PEs, each has one: at the end nobody waits for what another has in store.
constexpr std::uint32_t kSupply = 2;
/// Points are dealt in parts when fewer are left for each PE.
constexpr std::uint64_t kPointsUndivided = 2;
static_assert(kSupply <= protocol::kPointPlaces);
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
      shots_of_(settings_.pes + 1),
      deals_(settings_.pes),
      supplied_(settings_.pes),
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
    shots_of_[of.pe].push_back({candidate, number++, of.points});
  }
  port.work(HostWork::entry, settings_.gatherings.size());
  list_owners();
  begin_dealing(port);
}

double RadiosityPhase::gathered() const {
  if (!gathers_ || settings_.gatherings.empty()) return 0;
  double points = 0;
  for (const FinalGather& of : settings_.gatherings) points += of.points;
  return 1 - static_cast<double>(points_left_) / points;
}

void RadiosityPhase::begin_dealing(HostPort& port) {
  state_ = State::shooting;
  rounds_.back().pes = static_cast<std::uint32_t>(owners_.size());
  wanting_.clear();
  for (std::uint32_t i = 0; i < kSupply; ++i) {
    for (unsigned pe = 0; pe < settings_.pes; ++pe) wanting_.push_back(static_cast<PeNumber>(pe));
  }
  // Credits wait at the PEs until the points have been made; with those that have nothing to do, until the recall.
  const bool granted = settings_.points_travel && credits_.grant_all(port);
  deal(port);
  for (unsigned pe = 0; pe < settings_.pes && !granted; ++pe) {
    if (supplied_[pe] > 0) credits_.grant_share(port, static_cast<PeNumber>(pe));
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
    shots_of_[candidates_[i].pe].push_back(
        {candidate, static_cast<std::uint32_t>(shots_ + i),
         protocol::points_of_shot(candidate.kind, flux, settings_.points_per_quantum, settings_.shot_points,
                                  settings_.emission_points)});
  }
  list_owners();
}

/// Of the shots that are to be dealt.
void RadiosityPhase::list_owners() {
  owners_.clear();
  points_left_ = 0;
  turn_ = 0;
  for (const auto& shots : shots_of_) {
    for (const RoundShot& shot : shots) points_left_ += shot.points;
  }
  for (unsigned pe = 0; pe < settings_.pes; ++pe) {
    if (!shots_of_[pe].empty()) owners_.push_back(static_cast<PeNumber>(pe));
  }
}

/// They are the host's to deal: of nothing in the scene, and all of them in the first round.
void RadiosityPhase::add_sky_shots() {
  for (std::uint32_t i = 0; i < settings_.sky.size(); ++i) {
    const SkyShot& sky = settings_.sky[i];
    for (std::size_t c = 0; c < 3; ++c) sky_shot_[c] += sky.flux[c];
    Candidate opening{};
    opening.number = i;
    shots_of_[sky_owner()].push_back({opening, 0, sky.points});
    points_left_ += sky.points;
  }
  owners_.push_back(sky_owner());
}

void RadiosityPhase::send_sky_point(HostPort& port, const RoundShot& shot, PeNumber to, bool divide) const {
  const SkyShot& sky = settings_.sky[shot.candidate.number];
  const std::uint32_t number = sky.points - shot.points;
  protocol::PointRecord point{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto upto = [&](std::int64_t n) {
      const std::int64_t each = sky.flux[c] / sky.points;
      return each * n + sky.flux[c] % sky.points * n / sky.points;
    };
    point.flux[c] = upto(std::int64_t{number} + 1) - upto(number);
  }
  point.polygon = shot.candidate.number;
  point.key = sky.key;
  point.kind = protocol::RecordKind::point;
  point.number_low = static_cast<std::uint8_t>(number);
  point.number_high = static_cast<std::uint8_t>(number >> 8U);
  const std::uint32_t part = divide ? shot.part + 1U : 0U;
  point.flags =
      static_cast<std::uint8_t>(std::uint32_t{protocol::kDirect} | protocol::kSky | (part << protocol::kPartShift));
  port.send_records(to, std::as_bytes(std::span(&point, 1)), sizeof point);
}

void RadiosityPhase::take_work_done(HostPort& port, PeNumber source, const protocol::WorkDone& done) {
  if (done.points > supplied_[source]) {
    throw MachineFailure("PE " + std::to_string(source) + " has done more than it was dealt");
  }
  rounds_.back().records += done.records;
  rounds_.back().last_shot_done = port.now();
  supplied_[source] -= done.points;
  under_way_ -= done.points;
  // Who has nothing left comes first.
  for (std::uint32_t i = 0; i < done.points; ++i) {
    if (supplied_[source] == 0) {
      wanting_.push_front(source);
    } else {
      wanting_.push_back(source);
    }
  }
  deal(port);
}

/// A point to each PE that wants one, as long as there are points; their owners make them in turn.
void RadiosityPhase::deal(HostPort& port) {
  while (!wanting_.empty() && !owners_.empty()) {
    port.work(HostWork::entry, 1);
    const PeNumber to = wanting_.front();
    const bool ends = points_left_ * protocol::kPointParts <= settings_.pes;
    if (ends && supplied_[to] > 0 && settings_.points_travel) break;
    wanting_.pop_front();
    turn_ = turn_ < owners_.size() ? turn_ : 0;
    const PeNumber at_home = shots_of_[to].empty() ? sky_owner() : to;
    const PeNumber owner = settings_.points_travel ? owners_[turn_++] : at_home;
    if (!shots_of_[owner].empty()) deal_point(port, owner, to);
  }
  for (const PeNumber owner : std::exchange(dealing_, {})) send_deal(port, owner);
}

void RadiosityPhase::deal_point(HostPort& port, PeNumber owner, PeNumber to) {
  RoundShot& shot = shots_of_[owner].front();
  const bool of_sky = owner == sky_owner();
  if (!shot.begun && !of_sky) begin_shot(port, owner, shot);
  const bool divide = shot.part > 0 || (settings_.points_travel && points_left_ < kPointsUndivided * settings_.pes);
  const std::uint32_t parts = divide ? protocol::kPointParts : 1U;
  if (of_sky) {
    send_sky_point(port, shot, to, divide);
  } else {
    add_to_deal(port, owner, to, parts);
  }
  ++supplied_[to];
  ++under_way_;
  shot.part = (shot.part + 1U) % parts;
  if (shot.part == 0) {
    --points_left_;
    --shot.points;
  }
  const bool last = shot.points == 0;
  if (!of_sky && (last || deals_[owner].count == protocol::Deal::kMost)) send_deal(port, owner);
  if (!last) return;
  shots_of_[owner].pop_front();
  if (shots_of_[owner].empty()) std::erase(owners_, owner);
}

void RadiosityPhase::add_to_deal(HostPort& port, PeNumber owner, PeNumber to, std::uint32_t parts) {
  protocol::Deal& deal = deals_[owner];
  if (deal.count > 0 && deal.parts != parts) send_deal(port, owner);
  if (deal.count == 0) dealing_.push_back(owner);
  deal.parts = parts;
  deal.pe[deal.count++] = to;
}

void RadiosityPhase::send_deal(HostPort& port, PeNumber owner) {
  protocol::Deal& deal = deals_[owner];
  if (deal.count == 0) return;
  const std::size_t bytes = offsetof(protocol::Deal, pe) + deal.count * sizeof(PeNumber);
  port.send_message(owner, static_cast<std::uint16_t>(MessageKind::deal),
                    std::as_bytes(std::span(&deal, 1)).first(bytes));
  deal.count = 0;
}

void RadiosityPhase::begin_shot(HostPort& port, PeNumber owner, RoundShot& shot) {
  const Candidate& candidate = shot.candidate;
  torolux::send(port, owner, MessageKind::shoot,
                protocol::Shoot{candidate.amount, candidate.patch, candidate.side, candidate.kind, shot.number});
  shot.begun = true;
}

/// Whoever has no work keeps its credits for what is dealt to it next: each way home and out again is two messages. But
/// at the end they are all needed at home, and before it where others wait for some.
void RadiosityPhase::recall_if_due(HostPort& port) {
  const bool all_made = owners_.empty() && under_way_ == 0 && !credits_.all_home();
  if (recalled_ || !(all_made || credits_.are_short())) return;
  recalled_ = true;
  port.broadcast(static_cast<std::uint16_t>(MessageKind::recall), {});
}

void RadiosityPhase::end_round_if_over(HostPort& port) {
  if (!owners_.empty() || under_way_ > 0 || !credits_.all_home()) return;
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
