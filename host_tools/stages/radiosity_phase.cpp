// SPDX-License-Identifier: MIT
// See radiosity_phase.hpp.
#include "host_tools/stages/radiosity_phase.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

#include "firmware/protocol/flux.hpp"

namespace torolux {
namespace {

using protocol::Candidate;
using protocol::Flux;
using protocol::MessageKind;
using protocol::ShotKind;

/// A PE turns a grant into records at once, and hears of nothing else meanwhile: so it is small.
constexpr std::uint64_t kGrant = 32;
/// Grants on their way to one PE: more would only wait there while another shooter could use them.
constexpr std::size_t kGrantsUnderWay = 2;

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

}  // namespace

RadiosityPhase::RadiosityPhase(RadiositySettings settings)
    : settings_(std::move(settings)), waiting_(settings_.pes), pool_(settings_.credits) {}

void RadiosityPhase::start(HostPort& port) {
  select(port);
}

void RadiosityPhase::select(HostPort& port) {
  state_ = State::selecting;
  answers_ = 0;
  unshot_ = 0;
  candidates_.clear();
  rounds_.push_back({});
  rounds_.back().begin = port.now();
  const protocol::Select message{settings_.shooters, 0, settings_.least_unshot};
  for (unsigned pe = 0; pe < settings_.pes; ++pe) {
    torolux::send(port, static_cast<PeNumber>(pe), MessageKind::select, message);
  }
}

void RadiosityPhase::on_message(HostPort& port, PeNumber source, MessageKind kind,
                                std::span<const std::byte> contents) {
  if (state_ == State::selecting && kind == MessageKind::candidates) {
    take_candidates(port, source, contents);
  } else if (state_ == State::shooting && kind == MessageKind::credits) {
    port.work(HostWork::entry, 1);
    pool_ += contents_as<protocol::Credits>(contents).count;
    if (pool_ > settings_.credits) throw MachineFailure("more credits came home than were handed out");
    grant(port);
    end_round_if_over(port);
  } else if (state_ == State::shooting && kind == MessageKind::shot_done) {
    port.work(HostWork::entry, shooting_.size());
    rounds_.back().records += contents_as<protocol::ShotDone>(contents).records;
    rounds_.back().last_shot_done = port.now();
    std::erase(shooting_, source);
    if (!waiting_[source].empty()) begin_shot(port, source);
    grant(port);
    end_round_if_over(port);
  } else {
    unexpected(source, kind, state_ == State::selecting ? "selecting shooters" : "shooting");
  }
}

void RadiosityPhase::take_candidates(HostPort& port, PeNumber source, std::span<const std::byte> contents) {
  const auto message = contents_as<protocol::Candidates>(contents, offsetof(protocol::Candidates, candidate));
  if (message.count > protocol::kMostCandidatesPerMessage ||
      contents.size() < offsetof(protocol::Candidates, candidate) + message.count * sizeof(Candidate)) {
    throw MachineFailure("PE " + std::to_string(source) + " sent candidates that are cut short");
  }
  port.work(HostWork::entry, message.count);
  for (std::uint32_t i = 0; i < message.count; ++i) {
    if (message.candidate[i].number >= settings_.reflectance.size()) {
      throw MachineFailure("PE " + std::to_string(source) + " offers a patch that does not exist");
    }
    candidates_.push_back({source, message.candidate[i]});
  }
  if (message.last == 0) return;
  unshot_ += message.unshot[0] + message.unshot[1] + message.unshot[2];
  if (++answers_ == settings_.pes) begin_round(port);
}

void RadiosityPhase::begin_round(HostPort& port) {
  port.work(HostWork::compare, compares_to_sort(candidates_.size()));
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Chosen& a, const Chosen& b) { return before(a.candidate, b.candidate); });
  std::uint64_t most = settings_.shooters;
  if (settings_.max_shots > 0) most = std::min<std::uint64_t>(most, settings_.max_shots - shots_);
  if (candidates_.size() > most) candidates_.resize(most);
  RoundFigures& round = rounds_.back();
  round.unshot = settings_.emitted > 0 ? static_cast<double>(unshot_) / settings_.emitted : 0;
  port.note(HostGauge::unshot, round.unshot);
  round.chosen = round.last_shot_done = round.end = port.now();
  if (candidates_.empty() || unshot_ <= settings_.enough_unshot) {
    state_ = State::done;
    return;
  }
  state_ = State::shooting;
  turn_ = 0;
  for (const Chosen& chosen : candidates_) {
    if (waiting_[chosen.pe].empty()) ++round.pes;
    waiting_[chosen.pe].push_back(chosen.candidate);
  }
  round.shooters = static_cast<std::uint32_t>(candidates_.size());
  for (unsigned pe = 0; pe < settings_.pes; ++pe) {
    if (!waiting_[pe].empty()) begin_shot(port, static_cast<PeNumber>(pe));
  }
  grant(port);
}

void RadiosityPhase::begin_shot(HostPort& port, PeNumber pe) {
  const Candidate candidate = waiting_[pe].front();
  waiting_[pe].pop_front();
  // The number seeds the shot's random numbers, so it follows the order of choice and not the order of starting.
  const auto chosen = std::find_if(candidates_.begin(), candidates_.end(), [&](const Chosen& other) {
    return !before(other.candidate, candidate) && !before(candidate, other.candidate);
  });
  const auto place = static_cast<std::uint64_t>(chosen - candidates_.begin());
  port.work(HostWork::compare, place + 1);
  const protocol::Shoot message{candidate.amount, candidate.patch, candidate.side, candidate.kind,
                                static_cast<std::uint32_t>(shots_ + place)};
  torolux::send(port, pe, MessageKind::shoot, message);
  shooting_.push_back(pe);
  for (std::size_t c = 0; c < 3; ++c) {
    if (candidate.kind == ShotKind::emitted) {
      emitted_shot_[c] += candidate.amount[c];
    } else {
      reflected_shot_[c] += protocol::scale_down(candidate.amount[c], settings_.reflectance[candidate.number][c]);
    }
  }
}

void RadiosityPhase::note_credits(HostPort& port) const {
  port.note(HostGauge::records_in_flight, static_cast<double>(settings_.credits - pool_));
}

void RadiosityPhase::grant(HostPort& port) {
  // In turn to all shooters; one that has grants waiting is passed over, and asked again when more credits come home.
  std::size_t passed_over = 0;
  while (pool_ > 0 && !shooting_.empty() && passed_over < shooting_.size()) {
    port.work(HostWork::entry, 1);
    turn_ = turn_ < shooting_.size() ? turn_ : 0;
    const PeNumber pe = shooting_[turn_++];
    if (port.queued(pe) >= kGrantsUnderWay) {
      ++passed_over;
      continue;
    }
    passed_over = 0;
    const auto credits = static_cast<std::uint32_t>(std::min(kGrant, pool_));
    pool_ -= credits;
    torolux::send(port, pe, MessageKind::grant, protocol::Grant{credits});
  }
  note_credits(port);
}

void RadiosityPhase::end_round_if_over(HostPort& port) {
  if (!shooting_.empty() || pool_ < settings_.credits) return;
  shots_ += candidates_.size();
  rounds_.back().end = port.now();
  if (settings_.max_shots > 0 && shots_ >= settings_.max_shots) {
    state_ = State::done;
    return;
  }
  select(port);
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
