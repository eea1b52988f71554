// SPDX-License-Identifier: MIT
// The points of a round's shots, dealt to PEs that want work until there are none left.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "host_tools/stages/phase.hpp"
#include "host_tools/stages/radiosity_settings.hpp"

namespace torolux {

class PointDealer {
 public:
  /// points_travel: to any PE; else each stays with its owner. sky: by opening.
  PointDealer(unsigned pes, bool points_travel, std::vector<SkyShot> sky);

  /// A shot of the round that is to begin. owner: makes its points; number: of the shot, over the stage; points: > 0.
  void add(PeNumber owner, const protocol::Candidate& candidate, std::uint32_t number, std::uint32_t points);
  /// Those of all openings: of nothing in the scene, so the host makes their points.
  void add_sky();
  /// All PEs want points. Returns how many have shots; the sky counts as one.
  std::uint32_t begin();
  /// A point to each PE that wants one, as long as there are points; their owners make them in turn.
  void deal(HostPort& port);
  /// Of a `work_done` message: who has done points wants more. Throws MachineFailure where it has not had so many.
  void take_done(PeNumber source, std::uint32_t points);

  /// It has points that it has not done.
  bool supplies(PeNumber pe) const { return supplied_[pe] > 0; }
  /// All that the round has.
  bool all_done() const { return owners_.empty() && under_way_ == 0; }
  std::uint64_t points_left() const { return points_left_; }  ///< to be dealt
  template <class Archive>
  void archive(Archive& archive) {
    archive(shots_of_, owners_, turn_, deals_, dealing_, wanting_, supplied_, under_way_, points_left_);
  }

 private:
  struct Shot {
    protocol::Candidate candidate;
    std::uint32_t number;    ///< of the shot, over the stage
    std::uint32_t points;    ///< left to be dealt
    std::uint32_t part = 0;  ///< of the next one, where it is dealt in parts
    bool begun = false;      ///< its owner has been told; of the sky there is nobody to be told
  };

  PeNumber sky_owner() const { return static_cast<PeNumber>(pes_); }
  void deal_point(HostPort& port, PeNumber owner, PeNumber to);
  void add_to_deal(HostPort& port, PeNumber owner, PeNumber to, std::uint32_t parts);
  void send_deal(HostPort& port, PeNumber owner);
  static void begin_shot(HostPort& port, PeNumber owner, Shot& shot);
  void send_sky_point(HostPort& port, const Shot& shot, PeNumber to, bool divide) const;

  unsigned pes_;
  bool points_travel_;
  std::vector<SkyShot> sky_;
  std::vector<std::deque<Shot>> shots_of_;  ///< with points left, by owner; behind the PEs the sky's
  std::vector<PeNumber> owners_;            ///< of those, in the order of PEs, the sky last
  std::size_t turn_ = 0;                    ///< of owners_: who makes the next point
  std::vector<protocol::Deal> deals_;       ///< being filled, by owner
  std::vector<PeNumber> dealing_;           ///< owners whose deal is being filled
  std::deque<PeNumber> wanting_;            ///< PEs that could do with a point more, longest ago first
  std::vector<std::uint32_t> supplied_;     ///< points that a PE has been dealt and not finished
  std::uint64_t under_way_ = 0;             ///< of those, in all
  std::uint64_t points_left_ = 0;           ///< to be dealt
};

}  // namespace torolux
