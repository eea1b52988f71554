// SPDX-License-Identifier: MIT
// A machine whose PEs run on other ranks, threads of this process with messages that are late at random: set-up and
// ranks enter, the outcome leaves.
#pragma once

#include <string>
#include <vector>

#include "emulator/ranks/thread_ranks.hpp"
#include "emulator/remote/pe_ranks.hpp"
#include "emulator/remote/serve_pes.hpp"
#include "tests/support/faulty_ranks.hpp"
#include "tests/unit/emulator/machine/wanderers.hpp"

namespace torolux::test {

struct RanksChoice {
  unsigned count = 2;
  remote::Placing placing = remote::Placing::block;
  ranks::Delays delays = {};
  ranks::LifeTimes times = {};
};

/// What each rank does; an empty one: as serve_pes.
using OtherRank = std::function<void(ranks::Transport&)>;

/// Sees, and may change, what rank 0 is sent; as TappedTransport's.
using Tap = std::function<bool(ranks::Message&)>;

/// work: rank 0's, with the others at hand. Leaves how each rank has ended; "": well.
inline std::vector<std::string> with_ranks(const RanksChoice& choice, const std::function<void(remote::PeRanks&)>& work,
                                           const OtherRank& other = {}, const Tap& tap = {}) {
  return ranks::run_as_threads(choice.count, choice.delays, [&](ranks::Transport& transport) {
    if (transport.ranks().own != 0)
      return other ? other(transport) : remote::serve_pes(transport, "the same", choice.times);
    TappedTransport tapped(
        transport, tap ? tap : [](ranks::Message&) { return true; });
    remote::PeRanks others(tapped, choice.placing, "the same", choice.times);
    try {
      work(others);
    } catch (...) {
      others.end(3);
      throw;
    }
    others.end(0);
  });
}

/// As `run`, on ranks.
inline MachineOutcome run_on(const RanksChoice& choice, const MachineSetup& setup, ListeningHost& host,
                             const NativeProgram& program, const NativeOptions& options = {}) {
  register_native_engine(program, options);
  MachineOutcome outcome;
  const auto ends = with_ranks(choice, [&](remote::PeRanks& others) {
    MachineSetup on_ranks = setup;
    on_ranks.ranks = &others;
    Machine machine(on_ranks, empty_image());
    machine.run(host);
    outcome = {host.heard, exact(machine.figures()), machine.figures()};
  });
  for (const std::string& end : ends) EXPECT_EQ(end, "");
  return outcome;
}

/// How rank 0 ends.
inline std::string failure_on(const RanksChoice& choice, const MachineSetup& setup, ListeningHost& host,
                              const NativeProgram& program, const OtherRank& other = {}) {
  register_native_engine(program);
  return with_ranks(
      choice,
      [&](remote::PeRanks& others) {
        MachineSetup on_ranks = setup;
        on_ranks.ranks = &others;
        Machine machine(on_ranks, empty_image());
        machine.run(host);
      },
      other)[0];
}

}  // namespace torolux::test
