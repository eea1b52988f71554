// SPDX-License-Identifier: MIT
// The network half of a machine that stands still, and the NIUs' channels, to bytes and back.
#include "emulator/machine/emulation.hpp"

namespace torolux {

void Emulation::archive_niu(SnapshotReader& archive, unsigned pe) {
  nius_[pe].restore(archive, pool_);
}

void Emulation::archive_niu(SnapshotWriter& archive, unsigned pe) {
  nius_[pe].save(archive);
  if (!engine_.save_channel(pe, archive)) nius_[pe].save_channel(archive);
}

/// All that a run changes; what is neither here nor in the archives of the parts is set when a machine is made.
template <class Archive>
void Emulation::archive(Archive& archive) {
  archive.section("events");
  archive(events_, pool_);
  archive.section("NIUs");
  archive(times_.bounds, times_.releases);
  for (unsigned pe = 0; pe < pes_; ++pe) archive_niu(archive, pe);
  archive(parts_);
  archive.section("torus");
  archive(torus_);
  archive.section("bus");
  archive(bus_);
  archive.section("frame buffer");
  archive(controller_);
  archive.section("host");
  archive(host_);
  archive.section("figures");
  archive(now_, trace_hash_, messages_to_host_, stages_, begun_, time_line_, bus_busy_, host_busy_, kinds_);
}

void Emulation::let_rest() {
  for (unsigned pe = 0; pe < pes_; ++pe) {
    while (!at_rest(pe)) await(pe, kNever);
  }
}

/// A PE that waits to be woken may go on by itself where an arrival that is there decides (hint_receive.cpp): whether
/// one has is only known once none runs any more; and what is told to PEs of other ranks then may make room for more.
void Emulation::hold_at_rest() {
  const auto stands = [this](unsigned pe) { return at_rest(pe) || engine_.takes_turns(pe); };
  for (;;) {
    for (unsigned pe = 0; pe < pes_; ++pe) {
      while (!stands(pe)) await(pe, kNever);
    }
    engine_.hold();
    bool all = true;
    for (unsigned pe = 0; pe < pes_; ++pe) all = stands(pe) && nius_[pe].is_told() && all;
    if (all) return;
    engine_.let_go();
  }
}

void Emulation::let_go() {
  engine_.let_go();
}

void Emulation::save(SnapshotWriter& archive) {
  torus_.settle(now_);
  this->archive(archive);
}

void Emulation::restore(SnapshotReader& archive) {
  this->archive(archive);
  if (parts_.size() != pes_) refuse_snapshot("it has another number of PEs");
  controller_.tell_all_changed();
  resumed_ = true;
}

}  // namespace torolux
