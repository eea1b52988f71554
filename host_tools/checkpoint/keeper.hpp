// SPDX-License-Identifier: MIT
// When checkpoints of a render are written, and what is in them beside the machine.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "emulator/snapshot/keeper.hpp"

namespace torolux {

inline constexpr double kCheckpointMinutes = 5;

struct CheckpointChoice {
  std::optional<std::filesystem::path> file;  ///< none: nothing is kept
  std::uint32_t rounds = 0;                   ///< one every so many of the radiosity stage; 0: not by rounds
  double minutes = kCheckpointMinutes;        ///< one every so many of wall time; 0: not by time
  std::function<bool()> interrupted = {};     ///< null: never. Then one is written, and the run ends
  std::string identity = {};                  ///< of the run; a file with another one is of another run
};

/// What a render adds to a checkpoint, and says of where it is.
class CheckpointedRun {
 public:
  virtual ~CheckpointedRun() = default;
  virtual std::uint64_t rounds_ended() const = 0;  ///< of this machine's radiosity stage
  virtual bool finished() const = 0;               ///< the host's program
  virtual void save(SnapshotWriter& archive) = 0;
};

class CheckpointKeeper final : public SnapshotKeeper {
 public:
  explicit CheckpointKeeper(CheckpointChoice choice);

  /// A machine begins; run: of it. It outlives the machine's run.
  void watch(CheckpointedRun& run);
  /// As if it had been interrupted.
  void end() { ended_ = true; }
  bool is_due() override;
  /// Throws StateSaved once the file is there, where that was why it is written; InputError.
  void keep(const std::function<void(SnapshotWriter&)>& machine) override;

 private:
  using Clock = std::chrono::steady_clock;

  bool interrupted() const { return ended_ || (choice_.interrupted && choice_.interrupted()); }
  bool rounds_are_due() const;

  CheckpointChoice choice_;
  CheckpointedRun* run_ = nullptr;
  Clock::time_point written_;
  std::uint64_t written_rounds_ = 0;
  bool written_finished_ = false;
  bool ended_ = false;
};

}  // namespace torolux
