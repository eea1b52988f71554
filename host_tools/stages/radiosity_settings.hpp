// SPDX-License-Identifier: MIT
// What the host needs to know of scene and settings in the radiosity stage.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/protocol/flux.hpp"
#include "host_tools/setup/setup.hpp"

namespace torolux {

/// Light that comes in through one opening: the host makes the points of its shot.
struct SkyShot {
  protocol::Flux flux{};     ///< as PointRecord::flux has a part of it
  std::int64_t enters = 0;   ///< of it, about [quanta, R + G + B]
  std::uint32_t points = 0;  ///< at most kMostEmissionPoints squared
  std::uint32_t key = 0;     ///< of its random numbers
};

/// One side of a patch, whose elements gather when all shots are over.
struct FinalGather {
  protocol::PeNumber pe = 0;  ///< its owner
  std::uint32_t patch = 0;    ///< local
  std::uint32_t number = 0;   ///< global
  std::uint32_t side = 0;
  std::uint32_t points = 0;  ///< 1..protocol::kMostGatherPoints
};

struct RadiositySettings {
  unsigned pes = 1;
  std::uint64_t credits = 256;     ///< W, > 0
  std::uint32_t shooters = 8;      ///< S: shots in a round, 1..kMostShooters
  std::int64_t least_unshot = 0;   ///< sides with no more than this are not shot [quanta, R + G + B]
  std::int64_t enough_unshot = 0;  ///< the stage ends when no more than this is unshot [quanta, R + G + B]
  double emitted = 0;              ///< all that the emitters have [quanta, R + G + B]
  std::vector<SkyShot> sky;        ///< by opening
  std::uint32_t max_shots = 0;     ///< 0: no limit
  std::vector<std::array<protocol::Fraction, 3>> reflectance;  ///< by global patch
  std::uint32_t shot_points = 1, emission_points = 1;          ///< as in protocol::StageLayout
  float points_per_quantum = 1;
  std::vector<FinalGather> gatherings;  ///< by global side; empty: no final gathering
  double shot_records = 0;              ///< that all shots will make, roughly
  double gather_records = 0;            ///< that would take as long as all rays of final gathering
  bool points_travel = true;            ///< to whoever has little work; else each is expanded by the patch's owner
};

/// That all shots of a stage make, roughly; a draft makes fewer.
double foretold_shot_records(const Quality& quality);

RadiositySettings radiosity_settings(const Scene& scene, const RenderSetup& setup, const Quality& quality);

}  // namespace torolux
