// SPDX-License-Identifier: MIT
// The figures of a machine, or of one stage of it, enter; keys of the statistics leave, the same for `run` and
// `render`.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "emulator/machine/machine.hpp"
#include "host_tools/stages/rounds.hpp"

namespace torolux {

/// All but what there is one of for each PE, link, stage, round or slice of time.
nlohmann::ordered_json machine_json(const MachineFigures& machine);
/// One object for each PE. phases: as in MachineFigures.
nlohmann::ordered_json pes_json(const std::vector<PeFigures>& pes, const PhaseNames& phases);
/// One object for each stage: name, begin, cycles, the keys of machine_json, limits, pes.
nlohmann::ordered_json stages_json(const MachineFigures& machine, const std::vector<RoundFigures>& rounds);
/// One object for each PE: its four links, and those from and to its NIU.
nlohmann::ordered_json links_json(const MachineFigures& machine);
nlohmann::ordered_json time_line_json(const TimeLineFigures& line);
nlohmann::ordered_json rounds_json(const std::vector<RoundFigures>& rounds);

}  // namespace torolux
