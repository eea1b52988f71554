// SPDX-License-Identifier: MIT
// --trace and what belongs to it: options enter, a file with a trace leaves.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/trace/perfetto_trace.hpp"

namespace CLI {
class App;
}

namespace torolux {

struct TraceOptions {
  std::optional<std::filesystem::path> file;
  std::optional<std::array<Cycles, 2>> window;
  std::vector<unsigned> pes;
  std::optional<std::uint64_t> most_bytes, grain, arrows;
};

/// What is told of a run where the options do not say it.
enum class TracedRun : std::uint8_t { render, image };

/// --trace, --trace-window, --trace-pes, --trace-grain, --trace-arrows, --trace-limit.
void add_trace_options(CLI::App& command, TraceOptions& options, TracedRun run, const std::string& group);

/// Throws UsageError where options of a trace are given without one; InputError: a PE that is not in the machine.
TraceChoice trace_choice(const TraceOptions& options, TracedRun run, unsigned pes);

/// A trace on its way into its file, which is there once `finish` has been called.
class TraceFile {
 public:
  TraceFile(const std::filesystem::path& file, TraceChoice choice);
  MachineWatcher& watcher() { return trace_; }
  /// After the run; or after its failure, with what it had told until then. Throws InputError.
  void finish();
  /// What the user should know of it; empty: nothing.
  std::string note() const;

 private:
  std::filesystem::path name_;
  FileWriter file_;
  PerfettoTrace trace_;
};

/// What run() returns. Where the machine fails, the trace (null: none) is there with what was told until then.
template <class Run>
auto run_traced(TraceFile* trace, Run run) {
  try {
    return run();
  } catch (const MachineFailure&) {
    if (trace != nullptr) trace->finish();
    throw;
  }
}

/// Nothing where no trace is asked for. Throws UsageError, InputError.
std::unique_ptr<TraceFile> trace_file(const TraceOptions& options, TracedRun run, unsigned pes);

}  // namespace torolux
