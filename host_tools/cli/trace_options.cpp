// SPDX-License-Identifier: MIT
// Words into a choice; bytes into a file.
#include "host_tools/cli/trace_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <utility>

#include "emulator/errors.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/table_options.hpp"
#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

constexpr std::uint64_t kMostTraceBytes = std::uint64_t{64} << 30U;
constexpr std::uint64_t kMostGrain = std::uint64_t{1} << 40U;
constexpr std::uint64_t kMostArrows = 1'000'000'000;
/// Of a window, at least so many grains are shown.
constexpr std::uint64_t kGrainsOfWindow = 4096;

/// Of a render, where nothing is said; every state and packet of what `torolux run` runs, which is mostly short.
constexpr std::uint64_t kRenderGrain = 65536, kRenderArrows = 256;
constexpr std::uint64_t grain_of(TracedRun run) {
  return run == TracedRun::render ? kRenderGrain : 1;
}
constexpr std::uint64_t arrows_of(TracedRun run) {
  return run == TracedRun::render ? kRenderArrows : 1;
}

std::uint32_t shift_of(std::uint64_t grain) {
  return static_cast<std::uint32_t>(std::bit_width(grain) - 1);
}

}  // namespace

void add_trace_options(CLI::App& command, TraceOptions& options, TracedRun run, const std::string& group) {
  const auto add = [&](const std::string& name, const std::string& form, const std::string& help, auto parse) {
    CLI::Option* option = add_value(command, name, form, help, parse);
    if (!group.empty()) option->group(group);
    return option;
  };
  add("--trace", "FILE.pftrace", "What happened when, for ui.perfetto.dev (docs/trace.md)",
      [&options](const std::string& text) {
        if (text.empty()) throw UsageError("the name is empty");
        options.file = text;
      });
  add("--trace-window", "FROM:TO", "Of the trace: these cycles alone [all]",
      [&options](const std::string& text) { options.window = parse_window(text); });
  add("--trace-pes", "LIST", "Of the trace: these PEs alone, like 0-3,7 [all]",
      [&options](const std::string& text) { options.pes = parse_pe_list(text); });
  add("--trace-grain", "CYCLES",
      std::string("Of the trace: so many cycles are shown as one state; a power of two; 1: every state as it was [") +
          std::to_string(grain_of(run)) + "; of a window at most 1/4096]",
      [&options](const std::string& text) {
        options.grain = parse_count(text, 1, kMostGrain);
        if (!std::has_single_bit(*options.grain)) throw InputError("\"" + text + "\" is not a power of two");
      });
  add("--trace-arrows", "N", "Of the trace: one packet in N has an arrow from sender to receiver; 0: none",
      [&options](const std::string& text) { options.arrows = parse_count(text, 0, kMostArrows); })
      ->default_str(std::to_string(arrows_of(run)));
  add("--trace-limit", "SIZE", "Of the trace: its greatest size, K = 1024, M = 1024 K, G = 1024 M",
      [&options](const std::string& text) {
        options.most_bytes = parse_file_size(text, kLeastTraceBytes, kMostTraceBytes);
      })
      ->default_str("256M");
}

TraceChoice trace_choice(const TraceOptions& options, TracedRun run, unsigned pes) {
  TraceChoice choice;
  if (options.window) choice.from = options.window->front(), choice.to = options.window->back();
  if (!options.pes.empty() && options.pes.back() >= pes)
    throw InputError("--trace-pes: there is no PE " + std::to_string(options.pes.back()) + "; the machine has 0 to " +
                     std::to_string(pes - 1));
  choice.pes = options.pes;
  choice.most_bytes = options.most_bytes.value_or(choice.most_bytes);
  std::uint64_t grain = grain_of(run);
  if (options.window && choice.to != ~Cycles{0})
    grain = std::min(grain, std::bit_floor(std::max<std::uint64_t>(1, (choice.to - choice.from) / kGrainsOfWindow)));
  choice.grain_shift = shift_of(options.grain.value_or(grain));
  choice.arrows = options.arrows.value_or(arrows_of(run));
  return choice;
}

TraceFile::TraceFile(const std::filesystem::path& file, TraceChoice choice)
    : name_(file),
      file_(file),
      trace_(std::move(choice), [this](std::string_view bytes) { file_.append(std::as_bytes(std::span(bytes))); }) {}

void TraceFile::finish() {
  trace_.finish();
  file_.finish();
}

std::string TraceFile::note() const {
  if (!trace_.full_at()) return "";
  return name_.string() + ": full: what comes after cycle " + std::to_string(*trace_.full_at()) +
         " is not in the trace. More room: --trace-limit; less to say: a greater --trace-grain, --trace-window, "
         "--trace-pes";
}

std::unique_ptr<TraceFile> trace_file(const TraceOptions& options, TracedRun run, unsigned pes) {
  if (!options.file) {
    const bool any = options.window || !options.pes.empty() || options.most_bytes || options.grain || options.arrows;
    if (any) throw UsageError("--trace-... says what goes into a trace; --trace FILE says where it goes");
    return nullptr;
  }
  return std::make_unique<TraceFile>(*options.file, trace_choice(options, run, pes));
}

}  // namespace torolux
