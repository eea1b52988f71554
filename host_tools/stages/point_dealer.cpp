// SPDX-License-Identifier: MIT
// Who wants work gets the next point of the next owner, in turn; of the sky from the host itself.
#include "host_tools/stages/point_dealer.hpp"

#include <string>
#include <utility>

namespace torolux {
namespace {

using protocol::Candidate;
using protocol::MessageKind;

/// Points, or parts of points, that a PE has at a time: while the next one is on its way, it works on the other. When
/// no more are left than there are PEs, each has one: at the end nobody waits for what another has in store.
constexpr std::uint32_t kSupply = 2;
/// Points are dealt in parts when fewer are left for each PE.
constexpr std::uint64_t kPointsUndivided = 2;
static_assert(kSupply <= protocol::kPointPlaces);

}  // namespace

PointDealer::PointDealer(unsigned pes, bool points_travel, std::vector<SkyShot> sky)
    : pes_(pes), points_travel_(points_travel), sky_(std::move(sky)), shots_of_(pes + 1), deals_(pes), supplied_(pes) {}

void PointDealer::add(PeNumber owner, const Candidate& candidate, std::uint32_t number, std::uint32_t points) {
  shots_of_[owner].push_back({candidate, number, points});
}

void PointDealer::add_sky() {
  for (std::uint32_t i = 0; i < sky_.size(); ++i) {
    Candidate opening{};
    opening.number = i;
    add(sky_owner(), opening, 0, sky_[i].points);
  }
}

std::uint32_t PointDealer::begin() {
  owners_.clear();
  points_left_ = 0;
  turn_ = 0;
  for (std::size_t owner = 0; owner < shots_of_.size(); ++owner) {
    for (const Shot& shot : shots_of_[owner]) points_left_ += shot.points;
    if (!shots_of_[owner].empty()) owners_.push_back(static_cast<PeNumber>(owner));
  }
  wanting_.clear();
  for (std::uint32_t i = 0; i < kSupply; ++i) {
    for (unsigned pe = 0; pe < pes_; ++pe) wanting_.push_back(static_cast<PeNumber>(pe));
  }
  return static_cast<std::uint32_t>(owners_.size());
}

void PointDealer::take_done(PeNumber source, std::uint32_t points) {
  if (points > supplied_[source]) {
    throw MachineFailure("PE " + std::to_string(source) + " has done more than it was dealt");
  }
  supplied_[source] -= points;
  under_way_ -= points;
  // Who has nothing left comes first.
  for (std::uint32_t i = 0; i < points; ++i) {
    if (supplied_[source] == 0) {
      wanting_.push_front(source);
    } else {
      wanting_.push_back(source);
    }
  }
}

void PointDealer::send_sky_point(HostPort& port, const Shot& shot, PeNumber to, bool divide) const {
  const SkyShot& sky = sky_[shot.candidate.number];
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

void PointDealer::deal(HostPort& port) {
  while (!wanting_.empty() && !owners_.empty()) {
    port.work(HostWork::entry, 1);
    const PeNumber to = wanting_.front();
    const bool ends = points_left_ * protocol::kPointParts <= pes_;
    if (ends && supplied_[to] > 0 && points_travel_) break;
    wanting_.pop_front();
    turn_ = turn_ < owners_.size() ? turn_ : 0;
    const PeNumber at_home = shots_of_[to].empty() ? sky_owner() : to;
    const PeNumber owner = points_travel_ ? owners_[turn_++] : at_home;
    if (!shots_of_[owner].empty()) deal_point(port, owner, to);
  }
  for (const PeNumber owner : std::exchange(dealing_, {})) send_deal(port, owner);
}

void PointDealer::deal_point(HostPort& port, PeNumber owner, PeNumber to) {
  Shot& shot = shots_of_[owner].front();
  const bool of_sky = owner == sky_owner();
  if (!shot.begun && !of_sky) begin_shot(port, owner, shot);
  const bool divide = shot.part > 0 || (points_travel_ && points_left_ < kPointsUndivided * pes_);
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

void PointDealer::add_to_deal(HostPort& port, PeNumber owner, PeNumber to, std::uint32_t parts) {
  protocol::Deal& deal = deals_[owner];
  if (deal.count > 0 && deal.parts != parts) send_deal(port, owner);
  if (deal.count == 0) dealing_.push_back(owner);
  deal.parts = parts;
  deal.pe[deal.count++] = to;
}

void PointDealer::send_deal(HostPort& port, PeNumber owner) {
  protocol::Deal& deal = deals_[owner];
  if (deal.count == 0) return;
  const std::size_t bytes = offsetof(protocol::Deal, pe) + deal.count * sizeof(PeNumber);
  port.send_message(owner, static_cast<std::uint16_t>(MessageKind::deal),
                    std::as_bytes(std::span(&deal, 1)).first(bytes));
  deal.count = 0;
}

void PointDealer::begin_shot(HostPort& port, PeNumber owner, Shot& shot) {
  const Candidate& candidate = shot.candidate;
  torolux::send(port, owner, MessageKind::shoot,
                protocol::Shoot{candidate.amount, candidate.patch, candidate.side, candidate.kind, shot.number});
  shot.begun = true;
}

}  // namespace torolux
