// SPDX-License-Identifier: MIT
// The host's credits in a stage: they go out to PEs that have work, and come home. docs/credits.md has the proof that
// none is lost.
#pragma once

#include <cstdint>
#include <deque>

#include "host_tools/stages/phase.hpp"

namespace torolux {

class CreditPool {
 public:
  /// credits: W, > 0, all of them home.
  CreditPool(std::uint64_t credits, unsigned pes) : credits_(credits), pes_(pes), home_(credits) {}

  std::uint64_t home() const { return home_; }
  bool all_home() const { return home_ == credits_; }
  /// Somebody has asked, and none is home.
  bool are_short() const { return home_ == 0 && !hungry_.empty(); }
  /// The host makes a record itself. One is home.
  void spend() { --home_; }

  /// A `credits` message. Throws MachineFailure where more come than went out.
  void take_home(HostPort& port, PeNumber source, std::span<const std::byte> contents);
  /// Half of an equal share to each PE, by broadcast; the other half is for those that ask. False: that would be none.
  bool grant_all(HostPort& port);
  /// At the beginning: an equal share, or what is left.
  void grant_share(HostPort& port, PeNumber pe);
  /// A `need` message: the PE has work and no credits.
  void ask(HostPort& port, PeNumber pe);
  /// PEs that have asked get half of an equal share each, as long as credits are home; whoever asked first comes first.
  void feed(HostPort& port);
  /// For the time line.
  void note(HostPort& port) const;
  template <class Archive>
  void archive(Archive& archive) {
    archive(home_, hungry_);
  }

 private:
  void grant(HostPort& port, PeNumber pe, std::uint64_t credits);

  std::uint64_t credits_;
  unsigned pes_;
  std::uint64_t home_;
  std::deque<PeNumber> hungry_;  ///< have asked; nobody while credits are home
};

}  // namespace torolux
