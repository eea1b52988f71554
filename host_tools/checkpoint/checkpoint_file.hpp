// SPDX-License-Identifier: MIT
// A checkpoint as a file: what run it is of and the state of that run enter; a file that is whole leaves, and the other
// way round.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "emulator/snapshot/archive.hpp"

namespace torolux {

/// Rises with every change of what any class puts into its archive.
inline constexpr std::uint16_t kCheckpointVersion = 5;

/// Written beside `file` and renamed by `finish`: what was there before stays until then.
class CheckpointWriter {
 public:
  /// identity: a text by which the run is known again. Throws InputError, as all of this does.
  CheckpointWriter(const std::filesystem::path& file, const std::string& identity);
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;
  ~CheckpointWriter();

  SnapshotWriter& state();
  void finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

class CheckpointReader {
 public:
  /// Reads the file once to check it. Throws InputError: not there, no checkpoint, of another version, damaged.
  explicit CheckpointReader(const std::filesystem::path& file);
  CheckpointReader(const CheckpointReader&) = delete;
  CheckpointReader& operator=(const CheckpointReader&) = delete;
  ~CheckpointReader();

  const std::string& identity() const;
  /// To be read once, from its beginning. Throws InputError where there is no more.
  SnapshotReader& state();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace torolux
