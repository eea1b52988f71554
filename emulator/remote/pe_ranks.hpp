// SPDX-License-Identifier: MIT
// Rank 0's hold on the ranks that run PEs, for one machine after the other. Messages for them enter, theirs leave; one
// that fails or falls silent ends the run and is named.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulator/machine/pes_elsewhere.hpp"
#include "emulator/ranks/life_signs.hpp"
#include "emulator/remote/placing.hpp"
#include "emulator/remote/wire.hpp"

namespace torolux::remote {

/// For one thread.
class PeRanks final : public PesElsewhere {
 public:
  /// transport: of rank 0 of at least two; outlives this. program: which build this is.
  PeRanks(ranks::Transport& transport, Placing placing, std::string program, ranks::LifeTimes times = {});

  void check(const MachineSetup& setup) const override;
  std::unique_ptr<Engine> make_engine(const MachineSetup& setup, const ImageSet& images,
                                      std::vector<PeMemory>& pes) override;

  /// Of each PE.
  std::vector<unsigned> place(unsigned pes) const;
  /// Machines are made one after the other: a number for each.
  std::uint32_t next_machine() { return machines_++; }
  /// This one included.
  unsigned count() const { return transport_.ranks().count; }
  /// Of these ranks, by their numbers: how many are on the computer of this one. Waits until all have said where.
  unsigned sharers(unsigned rank, const std::vector<unsigned>& of);
  /// Whether it is on this computer, as far as that is known.
  bool is_here(unsigned rank) const;

  void send(unsigned rank, Kind kind, std::span<const std::byte> bytes = {});
  /// The next message that is there. Throws RankFailure: a rank has failed, is lost, or is of another build.
  std::optional<ranks::Message> poll();
  /// Sleeps until there is one, for some milliseconds at most.
  void wait();
  /// Throws RankFailure where one is lost.
  void check_lost() const;
  std::string name_of(unsigned rank) const;

  /// All ranks end. The last call. Does not return where one is lost and ranks are processes.
  void end(int exit_code);

 private:
  void greet(const ranks::Message& message);

  ranks::Transport& transport_;
  Placing placing_;
  std::string program_;
  std::uint32_t machines_ = 0;
  std::vector<std::string> hosts_;        // by rank; empty: not known yet
  std::optional<ranks::LifeSigns> life_;  // until the end
};

}  // namespace torolux::remote
