// SPDX-License-Identifier: MIT
// A machine whose PEs a debugger holds, in a thread of its own: image and engine in; a socket for debuggers, then what
// was said and the figures, out.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "emulator/debugger/session.hpp"
#include "emulator/machine/machine.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {

/// How a run ended.
struct RunResult {
  std::vector<std::string> texts;  ///< "PE @ cycle: text"
  std::string figures;             ///< all that must be the same
  std::string failure;             ///< empty: none

  bool operator==(const RunResult&) const = default;
};

class DebuggedMachine {
 public:
  struct Options {
    std::string image;
    std::string engine = "interpreted";
    std::vector<unsigned> held;  ///< ascending; empty: nobody holds PEs
    unsigned threads = 1;
    bool goes_back = true;
  };
  explicit DebuggedMachine(Options options);
  DebuggedMachine(const DebuggedMachine&) = delete;
  DebuggedMachine& operator=(const DebuggedMachine&) = delete;
  ~DebuggedMachine();

  std::filesystem::path socket() const { return folder_.path() / "pes"; }
  const Image& image() const { return image_; }
  /// Of the first function whose name holds this.
  std::uint32_t address_of(const std::string& part_of_name) const;
  /// Waits for the end.
  RunResult wait();

 private:
  void run();
  MachineFigures run_once(SnapshotReader* from);

  Options options_;
  testing_support::TemporaryFolder folder_;
  Image image_;
  std::optional<debugger::Session> session_;
  RunResult result_;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

/// The same without a debugger.
RunResult plain_run(const DebuggedMachine::Options& options);

}  // namespace torolux::test
