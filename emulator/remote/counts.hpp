// SPDX-License-Identifier: MIT
// What a PE at rest has counted: from its channel to a message, and from there into the mirror, from which figures are
// made.
#pragma once

#include <cstdint>

#include "emulator/niu/channel.hpp"

namespace torolux::remote {

/// archive: SnapshotWriter on the PE's rank, SnapshotReader on rank 0.
template <class Archive>
void archive_counts(Archive& archive, NiuChannel& channel) {
  ProcessorState& state = channel.processor;
  archive(channel.clock, channel.waits, channel.copied, channel.instructions, channel.phase_cycles, state.phase_begin,
          state.waited, state.busy_since, state.stage, state.phase_depth, state.phases, state.busy, state.marks);
}

}  // namespace torolux::remote
