// SPDX-License-Identifier: MIT
// The figures of a machine, or of one stage of it, as keys of the statistics: the same for `run` and `render`.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "emulator/machine/machine.hpp"
#include "host_tools/stages/rounds.hpp"

namespace torolux {

/// packets, records, hops, bus, frame_buffer, host_processor, phases.
nlohmann::ordered_json machine_json(const MachineFigures& machine);
/// One object for each PE.
nlohmann::ordered_json pes_json(const std::vector<PeFigures>& pes);
/// One object for each stage: name, begin, cycles, the keys of machine_json, limits, pes.
nlohmann::ordered_json stages_json(const MachineFigures& machine, const std::vector<RoundFigures>& rounds);
nlohmann::ordered_json rounds_json(const std::vector<RoundFigures>& rounds);

}  // namespace torolux
