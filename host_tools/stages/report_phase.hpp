// SPDX-License-Identifier: MIT
// The end of the ray tracing stage: what each PE has counted goes home. Leaves: sums over all PEs.
#pragma once

#include "host_tools/stages/phase.hpp"
#include "host_tools/stages/rounds.hpp"

namespace torolux {

inline void add_visits(VisitSums& sums, const protocol::Visits& visits) {
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += visits[i];
}

class ReportPhase : public Phase {
 public:
  explicit ReportPhase(unsigned pes) : pes_(pes) {}

  void start(HostPort& port) override {
    for (unsigned pe = 0; pe < pes_; ++pe)
      torolux::send(port, static_cast<PeNumber>(pe), protocol::MessageKind::report);
  }
  void on_message(HostPort& port, PeNumber source, protocol::MessageKind kind,
                  std::span<const std::byte> contents) override {
    if (kind != protocol::MessageKind::tally) unexpected(source, kind, "reporting");
    port.work(HostWork::entry, 1);
    add_visits(visits_, contents_as<protocol::StageReport>(source, contents).visits);
    ++done_;
  }
  bool done() const override { return done_ == pes_; }
  const char* waiting_for() const override { return "reports of the PEs"; }
  void save(SnapshotWriter& archive) override { this->archive(archive); }
  void restore(SnapshotReader& archive) override { this->archive(archive); }

  const VisitSums& visits() const { return visits_; }

 private:
  template <class Archive>
  void archive(Archive& archive) {
    archive(done_, visits_);
  }

  unsigned pes_;
  unsigned done_ = 0;
  VisitSums visits_{};
};

}  // namespace torolux
