// SPDX-License-Identifier: MIT
// The host program behind `torolux run`. Enters: PEs' messages; leaves: lines of text, exit status, bytes of files.
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "emulator/host/host_program.hpp"
#include "host_tools/run/lines.hpp"
#include "host_tools/run/pe_text.hpp"
#include "host_tools/run/served_files.hpp"

namespace torolux {

/// How a PE's program has ended, where that was not 0.
struct PeExit {
  PeNumber pe;
  std::int32_t status;
  Cycles time;  ///< when the host learned of it

  template <class Archive>
  void archive(Archive& archive) {
    archive(pe, status, time);
  }

  int code() const { return static_cast<int>(static_cast<std::uint32_t>(status) % 256U); }  ///< of a process
};

class Listener final : public HostProgram {
 public:
  /// files outlives this.
  Listener(ServedFiles& files, const std::function<void(const PeText&)>& on_text);

  void start(HostPort& /*port*/) override {}
  /// Throws MachineFailure: a kind that it does not know, a message that its kind cannot be.
  void on_message(HostPort& port, PeNumber source, std::uint16_t kind, std::span<const std::byte> contents) override;
  /// It never has anything more to do: what counts is that the PEs have halted.
  bool finished() const override { return true; }
  const char* waiting_for() const override { return "text from the PEs"; }
  /// What is in files is not.
  bool can_be_saved() const override { return files_.are_none(); }
  void save(SnapshotWriter& archive) override { this->archive(archive); }
  /// Before the run. Throws InputError.
  void restore(SnapshotReader& archive) { this->archive(archive); }

  /// The run has ended, well or not: what is left of unfinished lines.
  void finish();
  const std::optional<PeExit>& first_exit() const { return first_exit_; }

 private:
  struct Request {
    HostPort& port;
    PeNumber source;
    std::string_view name;  ///< of the kind
    std::span<const std::byte> contents;
  };

  template <class Archive>
  void archive(Archive& archive) {
    archive(lines_, last_, first_exit_);
  }
  void text(const Request& request);
  void output(const Request& request);
  void exit_status(const Request& request);
  void file_open(const Request& request);
  void file_read(const Request& request);
  void file_write(const Request& request);
  void file_seek(const Request& request);
  void file_close(const Request& request);

  ServedFiles& files_;
  const std::function<void(const PeText&)>& on_text_;
  Lines lines_;
  Cycles last_ = 0;
  std::optional<PeExit> first_exit_;
};

}  // namespace torolux
