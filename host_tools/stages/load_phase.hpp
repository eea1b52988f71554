// SPDX-License-Identifier: MIT
// Loading: each PE's layout and stores over the bus. Enters: images; leaves: every PE ready. What all PEs hold alike is
// sent once, to all; to each goes only what it has of its own.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "host_tools/layout/stage_image.hpp"
#include "host_tools/stages/phase.hpp"

namespace torolux {

/// Where the loads come from. Each function is called once for each PE, the second when its turn comes.
struct Loads {
  std::function<protocol::StageLayout(PeNumber)> layout;
  std::function<std::vector<std::byte>(PeNumber)> image;
  /// As of a PE that has nothing of its own: its stores stand at the beginning of every PE's, but where those differ.
  /// Null: nothing is sent to all.
  std::shared_ptr<const PeLoad> common;
};

class LoadPhase : public Phase {
 public:
  LoadPhase(unsigned pes, Loads loads);

  void start(HostPort& port) override;
  void on_message(HostPort& port, PeNumber source, protocol::MessageKind kind,
                  std::span<const std::byte> contents) override;
  bool done() const override { return ready_ == pes_; }
  const char* waiting_for() const override { return "PEs to be loaded"; }
  void save(SnapshotWriter& archive) override { archive(started_, ready_); }
  void restore(SnapshotReader& archive) override;
  double fraction() const { return static_cast<double>(ready_) / pes_; }

 private:
  void send_common(HostPort& port) const;
  void load(HostPort& port, PeNumber pe);

  unsigned pes_;
  Loads loads_;
  std::vector<protocol::StageLayout> layouts_;
  unsigned started_ = 0;
  unsigned ready_ = 0;
};

}  // namespace torolux
