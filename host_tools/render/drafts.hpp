// SPDX-License-Identifier: MIT
// How far the drafts of a render are: what the machines that have solved some of them left for those that follow.
#pragma once

#include <cstdint>
#include <vector>

#include "emulator/host/host_program.hpp"
#include "host_tools/irradiance/refine.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/render/render.hpp"

namespace torolux {

struct Drafts {
  bool over = false;          ///< the picture's machine is next, or under way
  std::uint32_t round = 0;    ///< of the next draft, or of the one under way
  std::uint32_t half = 0;     ///< which of its two solutions
  std::uint64_t more = 0;     ///< elements that a round adds; known once the first has been solved
  std::vector<Split> splits;  ///< of the rounds that are over
  DraftLight light;           ///< of this round
  Cycles cycles = 0;          ///< of all machines that have ended
  std::uint64_t records = 0;  ///< likewise

  template <class Archive>
  void archive(Archive& archive) {
    archive.section("drafts");
    archive(over, round, half, more, splits, light.flux, light.of_record, cycles, records);
  }
};

class Watch;  // host_tools/render/machines.hpp

/// Finds where the mesh needs more elements, from where `drafts` is on. False: stopped by the watch's `progress`.
bool solve_drafts(const Scene& scene, const Camera& camera, const Quality& full, const MachineChoice& choice,
                  const Image& image, Watch& watch, Drafts& drafts);

}  // namespace torolux
