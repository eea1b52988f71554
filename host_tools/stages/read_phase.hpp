// SPDX-License-Identifier: MIT
// Read-out: patch sides, elements and tallies of all PEs over the bus. Enters: `data` messages; leaves: the solution.
#pragma once

#include <vector>

#include "host_tools/layout/placement.hpp"
#include "host_tools/solution/solution.hpp"
#include "host_tools/stages/phase.hpp"
#include "host_tools/stages/report_phase.hpp"

namespace torolux {

class ReadPhase : public Phase {
 public:
  /// layouts: of the radiosity stage, by PE.
  ReadPhase(const Mesh& mesh, const Placement& placement, std::vector<protocol::StageLayout> layouts);

  void start(HostPort& port) override;
  void on_message(HostPort& port, PeNumber source, protocol::MessageKind kind,
                  std::span<const std::byte> contents) override;
  bool done() const override { return done_ == layouts_.size(); }
  const char* waiting_for() const override { return "elements to be read"; }
  void save(SnapshotWriter& archive) override { this->archive(archive); }
  void restore(SnapshotReader& archive) override { this->archive(archive); }

  /// Shots and their flux are not known here and stay zero.
  Solution take_solution() { return std::move(solution_); }
  const VisitSums& visits() const { return visits_; }

 private:
  template <class Archive>
  void archive(Archive& archive) {
    archive(bytes_, solution_, visits_, done_);
  }

  struct Range {
    std::uint32_t address, bytes;
  };
  Range range_of(PeNumber pe) const;
  void ask(HostPort& port, PeNumber pe);
  void store(PeNumber pe);

  const Mesh& mesh_;
  const Placement& placement_;
  std::vector<protocol::StageLayout> layouts_;
  std::vector<std::vector<std::byte>> bytes_;  ///< read so far, by PE
  Solution solution_;
  VisitSums visits_{};
  std::size_t done_ = 0;
};

}  // namespace torolux
