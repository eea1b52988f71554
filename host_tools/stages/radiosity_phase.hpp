// SPDX-License-Identifier: MIT
// The radiosity stage as the host conducts it: rounds of selection and shots until little is unshot.
#pragma once

#include <vector>

#include "host_tools/layout/light_units.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/stages/credit_pool.hpp"
#include "host_tools/stages/phase.hpp"
#include "host_tools/stages/point_dealer.hpp"
#include "host_tools/stages/radiosity_settings.hpp"
#include "host_tools/stages/rounds.hpp"

namespace torolux {

class RadiosityPhase : public Phase {
 public:
  explicit RadiosityPhase(RadiositySettings settings);

  void start(HostPort& port) override;
  void on_message(HostPort& port, PeNumber source, protocol::MessageKind kind,
                  std::span<const std::byte> contents) override;
  bool done() const override { return state_ == State::done; }
  const char* waiting_for() const override;
  void save(SnapshotWriter& archive) override { this->archive(archive); }
  void restore(SnapshotReader& archive) override { this->archive(archive); }

  std::uint64_t shots() const { return shots_; }
  const std::vector<RoundFigures>& rounds() const { return rounds_; }  ///< the present one, not ended, included
  std::uint64_t credits_home() const { return credits_.home(); }
  double gathered() const;                                  ///< part of final gathering that is dealt, 0..1
  std::int64_t unshot() const { return selected_unshot_; }  ///< [quanta, R + G + B], at the last selection
  const protocol::Flux& emitted_shot() const { return emitted_shot_; }
  const protocol::Flux& reflected_shot() const { return reflected_shot_; }
  const protocol::Flux& sky_shot() const { return sky_shot_; }

 private:
  template <class Archive>
  void archive(Archive& archive) {
    archive(state_, candidates_, answers_, unshot_, selected_unshot_, threshold_, expected_, dealer_, gathers_,
            recalled_, credits_, shots_, rounds_, emitted_shot_, reflected_shot_, sky_shot_);
  }

  enum class State { selecting, shooting, done };
  struct Chosen {
    PeNumber pe;
    protocol::Candidate candidate;
  };

  void begin_selection(HostPort& port);
  void select(HostPort& port, std::int64_t threshold);
  std::uint64_t most_shots() const;
  void take_candidates(HostPort& port, PeNumber source, std::span<const std::byte> contents);
  void begin_round(HostPort& port);
  void add_shots();
  void begin_dealing(HostPort& port);
  void gather_or_end(HostPort& port);
  void take_work_done(HostPort& port, PeNumber source, const protocol::WorkDone& done);
  void add_sky_shots();
  void recall_if_due(HostPort& port);
  void end_round_if_over(HostPort& port);

  RadiositySettings settings_;
  State state_ = State::selecting;
  std::vector<Chosen> candidates_;
  unsigned answers_ = 0;              ///< PEs whose candidates are all here
  std::int64_t unshot_ = 0;           ///< of the PEs that have answered the present selection
  std::int64_t selected_unshot_ = 0;  ///< of all, at the last one
  std::int64_t threshold_ = 0;        ///< of the selection: PEs name only sides with more
  std::int64_t expected_ = 0;         ///< so much have this round's shots, if they are like those of the last one
  PointDealer dealer_;
  bool gathers_ = false;   ///< rounds are over, and elements gather
  bool recalled_ = false;  ///< PEs without work send their credits home
  CreditPool credits_;
  std::uint64_t shots_ = 0;
  std::vector<RoundFigures> rounds_;
  protocol::Flux emitted_shot_{};
  protocol::Flux reflected_shot_{};
  protocol::Flux sky_shot_{};
};

}  // namespace torolux
