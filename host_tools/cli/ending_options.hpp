// SPDX-License-Identifier: MIT
// --until, --timeout and --dump: when a run ends, and what is kept of it then.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "emulator/machine/machine.hpp"
#include "host_tools/files/distinct_files.hpp"
#include "host_tools/run/memory_dump.hpp"

namespace CLI {
class App;
}

namespace torolux {

struct EndingOptions {
  Cycles until = 0;                 ///< 0: to the end
  std::optional<unsigned> timeout;  ///< [s] of wall time
  std::vector<DumpRequest> dumps;
};

void add_ending_options(CLI::App& command, EndingOptions& options);

/// The dumps, checked; their files can be written. Throws InputError.
std::vector<MemoryDump> checked_dumps(const EndingOptions& options, const MachineSetup& setup, const ImageSet& images);

/// For check_distinct.
std::vector<NamedFile> files_of(const std::vector<DumpRequest>& dumps);

/// The wall time that a run may take.
class Timeout {
 public:
  /// From now on; none: any time.
  explicit Timeout(std::optional<unsigned> seconds);
  /// To be called from the machine's `progress`. Throws MachineFailure, which tells where each PE stands.
  void check(const Machine& machine, Cycles now) const;
  /// To be called while a debugger holds the PEs: why the run is given up; "": it is not.
  std::string while_held() const;

 private:
  bool is_over() const;

  std::optional<unsigned> seconds_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace torolux
