// SPDX-License-Identifier: MIT
// Looks at clock, rounds and Ctrl-C whenever the host has read a message; writes the file beside the one that is there.
#include "host_tools/checkpoint/keeper.hpp"

#include <utility>

#include "host_tools/checkpoint/checkpoint_file.hpp"

namespace torolux {

CheckpointKeeper::CheckpointKeeper(CheckpointChoice choice) : choice_(std::move(choice)), written_(Clock::now()) {}

void CheckpointKeeper::watch(CheckpointedRun& run) {
  run_ = &run;
  written_rounds_ = run.rounds_ended();
  written_finished_ = false;
}

bool CheckpointKeeper::rounds_are_due() const {
  return choice_.rounds != 0 && run_->rounds_ended() - written_rounds_ >= choice_.rounds;
}

bool CheckpointKeeper::is_due() {
  if (interrupted() || rounds_are_due() || (run_->finished() && !written_finished_)) return true;
  return choice_.minutes > 0 &&
         Clock::now() - written_ >= std::chrono::duration<double, std::ratio<60>>(choice_.minutes);
}

void CheckpointKeeper::keep(const std::function<void(SnapshotWriter&)>& machine) {
  CheckpointWriter writer(*choice_.file, choice_.identity);
  run_->save(writer.state());
  machine(writer.state());
  writer.finish();
  written_ = Clock::now();
  written_rounds_ = run_->rounds_ended();
  written_finished_ = run_->finished();
  if (interrupted()) throw StateSaved("the run was interrupted, and its state saved");
}

}  // namespace torolux
