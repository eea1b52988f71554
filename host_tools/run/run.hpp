// SPDX-License-Identifier: MIT
// Any firmware image on a machine with no scene: its text messages come out, and the figures of the run.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/machine/machine.hpp"
#include "host_tools/files/digest.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/run/listener.hpp"
#include "host_tools/run/pe_text.hpp"
#include "host_tools/run/served_files.hpp"

namespace torolux {

struct RunOutcome {
  MachineFigures figures;
  std::optional<PeExit> first_exit;  ///< in virtual time, of a program that has ended with another status than 0
};

/// Runs the image until every PE has halted. on_text is called for each line or message of text, progress as by
/// Machine::run, with the machine to look at. files: what programs may open; not finished here.
/// Throws InputError (the image does not fit), MachineFailure (trap, dead PE, PEs that wait for ever, ...).
RunOutcome run_program(const MachineSetup& setup, const Image& image, ServedFiles& files,
                       const std::function<void(const PeText&)>& on_text,
                       const std::function<bool(const Machine&, Cycles)>& progress);

/// The same without files.
MachineFigures run_image(const MachineSetup& setup, const Image& image,
                         const std::function<void(const PeText&)>& on_text,
                         const std::function<bool(const Machine&, Cycles)>& progress);

/// The figures as one JSON object, ended by a line end; the keys are those of `torolux render --stats`.
std::string run_stats_json(const MachineSetup& setup, const ProgramFiles& inputs,
                           const MachineFigures& figures, double wall_seconds);

}  // namespace torolux
