// SPDX-License-Identifier: MIT
// The settings of the machine that makes a picture: its description, its size, how a scene is shared out on it, what
// runs it. None of them shows in the picture.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "emulator/description/description.hpp"
#include "emulator/engines/engine/debugging.hpp"
#include "emulator/engines/engine_names.hpp"
#include "host_tools/settings/scheme.hpp"

namespace torolux {

class MachineWatcher;  // emulator/trace/watcher.hpp
class Pacer;           // emulator/trace/pacer.hpp
class HopWatcher;      // emulator/torus/hop_watcher.hpp
struct TurnLog;        // emulator/engines/engine/turn_log.hpp
namespace profile {
class CycleProfile;  // emulator/profile/cycle_profile.hpp
}
class PesElsewhere;    // emulator/machine/pes_elsewhere.hpp
class RecordFollower;  // host_tools/setup/record_follower.hpp

/// The machine that makes it.
struct MachineChoice {
  MachineDescription description;
  unsigned columns = 4, rows = 4;
  std::optional<std::uint32_t> pe_memory;                 ///< bytes; absent: smallest power of two from 1 MiB that fits
  std::optional<std::array<std::uint32_t, 3>> subspaces;  ///< absent: auto
  Scheme scheme = Scheme::spread;  ///< the values below are its own; another scheme's: take_scheme
  std::string allocation = allocation_of(Scheme::spread);
  std::optional<double> replicate;  ///< most of a PE's memory for copies of subspaces, 0..1; absent: what fits
  Points points = points_of(Scheme::spread);
  Empty empty = empty_of(Scheme::spread);
  RayMaker camera_rays = camera_rays_of(Scheme::spread);
  bool skip_empty_subspaces = true;  ///< the host's camera rays begin in the first subspace on their way that is full
  std::string engine = kDefaultEngine;
  Debugging debugging;
  unsigned threads = 0;
  MachineWatcher* watcher = nullptr;   ///< of the machine that makes the picture, not of drafts'; outlives the render
  RecordFollower* follower = nullptr;  ///< likewise
  Pacer* pacer = nullptr;              ///< likewise
  HopWatcher* hop_watcher = nullptr;   ///< likewise
  profile::CycleProfile* profile = nullptr;  ///< likewise; with the engine `interpreted` alone
  PesElsewhere* ranks = nullptr;  ///< run the PEs, of drafts' machines too; likewise. Null: this process does
  TurnLog* turns = nullptr;       ///< of the machine that makes the picture; by an engine of one thread here; likewise
  std::function<bool()> interrupted = {};  ///< asked while engines get ready; null: never
  double progress_seconds = 0.1;  ///< from one call of a render's `progress` to the next, about [s of wall time]
};

/// The scheme, and all that it has where nothing else is said.
inline void take_scheme(MachineChoice& machine, Scheme scheme) {
  machine.scheme = scheme;
  machine.allocation = allocation_of(scheme);
  machine.replicate = replicate_of(scheme);
  machine.points = points_of(scheme);
  machine.empty = empty_of(scheme);
  machine.camera_rays = camera_rays_of(scheme);
}

}  // namespace torolux
