// SPDX-License-Identifier: MIT
// Any firmware image on a machine with no scene: its text messages come out, and the figures of the run.
#pragma once

#include <functional>
#include <string>

#include "emulator/machine/machine.hpp"
#include "host_tools/files/digest.hpp"

namespace torolux {

/// One text message of a PE, in the order of virtual time.
struct PeText {
  Cycles time;  ///< when the host took it in
  PeNumber pe;
  std::string text;  ///< UTF-8; control characters replaced by '?'
};

/// Runs the image until every PE has halted. on_text is called for each message, progress as by Machine::run, with
/// the machine to look at.
/// Throws InputError (the image does not fit), MachineFailure (trap, dead PE, PEs that wait for ever, ...).
MachineFigures run_image(const MachineSetup& setup, const Image& image,
                         const std::function<void(const PeText&)>& on_text,
                         const std::function<bool(const Machine&, Cycles)>& progress);

/// The figures as one JSON object, ended by a line end; the keys are those of `torolux render --stats`.
std::string run_stats_json(const MachineSetup& setup, const InputFile& image, const MachineFigures& figures,
                           double wall_seconds);

}  // namespace torolux
