// SPDX-License-Identifier: MIT
// Loading: each PE's layout and stores over the bus. Enters: images; leaves: every PE ready.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/layout/stage_layout.hpp"
#include "host_tools/stages/phase.hpp"

namespace torolux {

struct PeLoad {
  protocol::StageLayout layout;
  std::vector<std::byte> image;  ///< from layout.cell_words.address on
};

class LoadPhase : public Phase {
 public:
  /// load_of: called once for each PE, when its turn comes.
  LoadPhase(unsigned pes, std::function<PeLoad(PeNumber)> load_of);

  void start(HostPort& port) override;
  void on_message(HostPort& port, PeNumber source, protocol::MessageKind kind,
                  std::span<const std::byte> contents) override;
  bool done() const override { return ready_ == pes_; }
  const char* waiting_for() const override { return "PEs to be loaded"; }
  double fraction() const { return static_cast<double>(ready_) / pes_; }

 private:
  void load(HostPort& port, PeNumber pe) const;

  unsigned pes_;
  std::function<PeLoad(PeNumber)> load_of_;
  unsigned started_ = 0;
  unsigned ready_ = 0;
};

}  // namespace torolux
