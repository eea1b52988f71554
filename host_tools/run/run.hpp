// SPDX-License-Identifier: MIT
// Any firmware image on a machine with no scene: its text messages come out, and the figures of the run.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/machine/machine.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/run/listener.hpp"
#include "host_tools/run/pe_text.hpp"
#include "host_tools/run/served_files.hpp"

namespace torolux {

struct RunOutcome {
  MachineFigures figures;
  std::optional<PeExit> first_exit;  ///< in virtual time, of a program that has ended with another status than 0
};

/// Called with the machine when its run has ended, failed or not.
using AtEnd = std::function<void(const Machine&)>;

/// Runs the images (an Image: all PEs have it) until every PE has halted, or until the set-up's end. on_text is called
/// for each line or message of text, progress as by Machine::run, with the machine to look at. files: what programs may
/// open; not finished here. from: of a debugger that goes back: the run goes on from there; null: from its beginning.
/// Throws InputError (the image does not fit), MachineFailure (trap, dead PE, PEs that wait for ever, ...).
RunOutcome run_program(const MachineSetup& setup, ImageSet images, ServedFiles& files,
                       const std::function<void(const PeText&)>& on_text,
                       const std::function<bool(const Machine&, Cycles)>& progress, const AtEnd& at_end = {},
                       SnapshotReader* from = nullptr);

/// The same without files.
MachineFigures run_image(const MachineSetup& setup, ImageSet images, const std::function<void(const PeText&)>& on_text,
                         const std::function<bool(const Machine&, Cycles)>& progress, const AtEnd& at_end = {});

/// The figures as one JSON object, ended by a line end; the keys are those of `torolux render --stats`.
std::string run_stats_json(const MachineSetup& setup, const ProgramFiles& inputs, const MachineFigures& figures,
                           double wall_seconds);

}  // namespace torolux
