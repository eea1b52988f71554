// SPDX-License-Identifier: MIT
// PEs as the host sees them in the radiosity stage: what they tell it, and what its messages say. Each message can come
// at any moment.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>

#include "host_tools/stages/radiosity_phase.hpp"
#include "tests/unit/host_tools/stages/fake_port.hpp"

namespace torolux::test {

using protocol::Candidate;
using protocol::MessageKind;
using protocol::Shoot;
using protocol::ShotKind;

inline Candidate candidate(std::int64_t unshot, std::uint32_t number, std::uint32_t side = 0,
                           ShotKind kind = ShotKind::reflected) {
  return {{2 * unshot, unshot, 4}, unshot, number, number / 3, side, kind};
}

inline void offer(RadiosityPhase& phase, FakePort& port, PeNumber pe, const std::vector<Candidate>& candidates,
                  std::int64_t unshot, bool last = true) {
  protocol::Candidates message{};
  message.count = static_cast<std::uint32_t>(candidates.size());
  message.last = last ? 1 : 0;
  message.unshot = {unshot, 0, 0};
  std::copy(candidates.begin(), candidates.end(), message.candidate.begin());
  const std::size_t bytes = offsetof(protocol::Candidates, candidate) + candidates.size() * sizeof(Candidate);
  phase.on_message(port, pe, MessageKind::candidates, std::as_bytes(std::span(&message, 1)).first(bytes));
}

inline RadiositySettings settings(unsigned pes) {
  RadiositySettings result;
  result.pes = pes;
  result.credits = 100;
  result.shooters = 4;
  result.least_unshot = 7;
  result.enough_unshot = 50;
  result.emitted = 10'000;
  result.reflectance.assign(30, {protocol::kOne / 2, protocol::kOne / 4, protocol::kOne});
  return result;
}

inline std::vector<std::pair<PeNumber, Shoot>> shots_in(const std::vector<Sent>& sent) {
  std::vector<std::pair<PeNumber, Shoot>> shots;
  for (const Sent& one : sent) {
    if (one.is(MessageKind::shoot)) shots.emplace_back(one.pe, one.as<Shoot>());
  }
  return shots;
}

/// Credits granted to PEs 0..pes-1, by PE: to one, or by broadcast to each.
inline std::map<PeNumber, std::uint32_t> grants_in(const std::vector<Sent>& sent, unsigned pes) {
  std::map<PeNumber, std::uint32_t> grants;
  for (const Sent& one : sent) {
    if (!one.is(MessageKind::grant)) continue;
    for (unsigned pe = 0; pe < pes; ++pe) {
      if (one.pe == pe || one.pe == protocol::kHost) {
        grants[static_cast<PeNumber>(pe)] += one.as<protocol::Grant>().credits;
      }
    }
  }
  return grants;
}

/// A point that was dealt, or a part of one.
struct Piece {
  PeNumber to;
  std::uint32_t of_point;  ///< in parts of kPointParts
};

/// In the order of dealing; of one owner or all.
inline std::vector<Piece> pieces_in(const std::vector<Sent>& sent, std::optional<PeNumber> owner = {}) {
  std::vector<Piece> pieces;
  for (const Sent& one : sent) {
    if (!one.is(MessageKind::deal) || (owner && one.pe != *owner)) continue;
    protocol::Deal deal{};
    std::memcpy(&deal, one.bytes.data(), std::min(one.bytes.size(), sizeof deal));
    EXPECT_EQ(one.bytes.size(), offsetof(protocol::Deal, pe) + deal.count * sizeof(PeNumber)) << "no more is sent";
    EXPECT_TRUE(deal.parts == 1 || deal.parts == protocol::kPointParts);
    for (std::uint32_t i = 0; i < deal.count; ++i) pieces.push_back({deal.pe[i], protocol::kPointParts / deal.parts});
  }
  return pieces;
}

/// Who was dealt something.
inline std::vector<PeNumber> deals_in(const std::vector<Sent>& sent, std::optional<PeNumber> owner = {}) {
  std::vector<PeNumber> to;
  for (const Piece& piece : pieces_in(sent, owner)) to.push_back(piece.to);
  return to;
}

/// Tells that all points dealt are done and all credits granted are home, until the host asks for candidates or is
/// done. Adds up the messages.
inline std::vector<Sent> finish_round(RadiosityPhase& phase, FakePort& port) {
  std::vector<Sent> all;
  for (std::vector<Sent> sent = port.take(); !sent.empty(); sent = port.take()) {
    all.insert(all.end(), sent.begin(), sent.end());
    if (sent.back().is(MessageKind::select)) break;
    for (const PeNumber to : deals_in(sent)) tell(phase, port, to, MessageKind::work_done, protocol::WorkDone{1, 5});
    for (const auto& [pe, credits] : grants_in(sent, port.pes())) tell(phase, port, pe, MessageKind::credits, credits);
  }
  return all;
}

/// One owner with one emitted shot of k x k points, the others with nothing; all asked.
inline RadiosityPhase one_shot(FakePort& port, RadiositySettings some, PeNumber owner, std::uint32_t k = 8) {
  some.emission_points = k;
  RadiosityPhase phase(some);
  phase.start(port);
  port.take();
  for (unsigned pe = 0; pe < some.pes; ++pe) {
    offer(phase, port, static_cast<PeNumber>(pe), {}, 1000, pe != owner);
    if (pe == owner) offer(phase, port, owner, {candidate(400, 1, 0, ShotKind::emitted)}, 1000);
  }
  return phase;
}

}  // namespace torolux::test
