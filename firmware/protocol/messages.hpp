// SPDX-License-Identifier: MIT
// Bus messages between the host and the Torolux firmware (pe.elf). Each is a MessageHeader and one of these structs.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/protocol/niu_window.hpp"
#include "firmware/protocol/records.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::protocol {

enum class MessageKind : std::uint16_t {
  // host -> PE
  configure = kFirstProgramMessage,  ///< StageLayout; the PE checks it and fails the run where it does not hold
  load,                              ///< LoadBlock, then its bytes
  load_store,                        ///< LoadStore, then its bytes: to all PEs at once
  begin,                             ///< nothing follows; answer: ready
  select,                            ///< Select; answer: candidates, one or more messages
  shoot,                             ///< Shoot: what the points that are dealt next are of
  deal,                              ///< Deal: who gets the shot's next points
  tile,                              ///< Tile: pixels whose rays this PE makes; answer, when it has: work_done
  view,                              ///< View: tiles from now on are of another camera, or take other samples
  grant,                             ///< Grant: credits for the records that this PE makes
  recall,                            ///< nothing follows: credits without work come home, until the next `select`
  read,                              ///< Read; answer: data
  report,                            ///< nothing follows; answer: tally
  stop,                              ///< nothing follows; the PE halts
  // PE -> host
  ready,       ///< nothing follows
  candidates,  ///< Candidates
  work_done,   ///< WorkDone: points, or tiles, that this PE has made into records
  need,        ///< nothing follows: it has work, and no credits; answer: grant, as soon as there are any
  credits,     ///< Credits that have come home
  data,        ///< LoadBlock, then its bytes
  tally,       ///< StageReport
};

struct StageReport {
  Tally tally;  ///< zero in the ray tracing stage
  Visits visits;
};
static_assert(sizeof(StageReport) <= kMostMessageBytes);

struct LoadBlock {
  std::uint32_t address;  ///< multiple of 4, inside the PE's free memory
  std::uint32_t bytes;    ///< 1..kMostLoadBytes, multiple of 4
};
inline constexpr std::uint32_t kMostLoadBytes = kMostMessageBytes - sizeof(LoadBlock);
using Read = LoadBlock;

/// Into a store, wherever it lies: for what all PEs have at the same place of it.
struct LoadStore {
  std::uint32_t store;   ///< StoreName; not the record slots
  std::uint32_t offset;  ///< bytes from its beginning, a multiple of 4
  std::uint32_t bytes;   ///< 1..kMostLoadStoreBytes, a multiple of 4
};
inline constexpr std::uint32_t kMostLoadStoreBytes = kMostMessageBytes - sizeof(LoadStore);

/// The S best sides by unshot flux. S is a function of the scene alone.
struct Select {
  std::uint32_t count;  ///< S, 1..kMostShooters
  std::uint32_t unused;
  std::int64_t threshold;  ///< [quanta, R + G + B] only sides with more than this
};
inline constexpr std::uint32_t kMostShooters = 1024;

enum class ShotKind : std::uint32_t {
  reflected = 0,
  emitted = 1,
  gathering = 2,  ///< no flux leaves: the side's elements look for what lights them, when all shots are over
};

/// One possible shot. Order: more unshot first; then lower patch number, front before back, emitted before reflected.
struct Candidate {
  Flux amount;           ///< reflected: incident flux to turn into a shot; emitted: flux to shoot
  std::int64_t unshot;   ///< R + G + B of the flux that the shot would carry
  std::uint32_t number;  ///< global patch
  std::uint32_t patch;   ///< local patch
  std::uint32_t side;    ///< 0 front, 1 back
  ShotKind kind;
};
static_assert(sizeof(Candidate) == 48);
inline constexpr std::uint32_t kMostCandidatesPerMessage = 20;

struct Candidates {
  std::uint32_t count;  ///< in this message
  std::uint32_t last;   ///< 1: no more follow
  Flux unshot;  ///< of all sides of the PE, below the threshold too: reflected and emitted (in each message alike)
  std::array<Candidate, kMostCandidatesPerMessage> candidate;  ///< only `count` of them are sent
};
static_assert(sizeof(Candidates) <= kMostMessageBytes);

/// The owner subtracts exactly `amount` and shoots `amount` times reflectance (reflected) or `amount` (emitted).
struct Shoot {
  Flux amount;          ///< gathering: points (1..kMostGatherPoints), and nothing
  std::uint32_t patch;  ///< local
  std::uint32_t side;
  ShotKind kind;
  std::uint32_t number;  ///< of the shot, counted by the host over the stage; seeds the random numbers
};
static_assert(sizeof(Shoot) == 40);

/// The shot's next points go to these PEs, one to each, in this order; or each of these PEs gets the next part of a
/// point. When all its points have been dealt, the shot is over for its owner.
struct Deal {
  static constexpr std::uint32_t kMost = 64;
  std::uint32_t count;  ///< 1..kMost; only so many are sent
  std::uint32_t parts;  ///< into which points are divided: 1 or kPointParts; no change within a point
  std::array<PeNumber, kMost> pe;
};

/// A rectangle of the picture.
struct Tile {
  std::uint16_t column, row;    ///< of its first pixel; row 0 on top
  std::uint16_t columns, rows;  ///< 1 or more
};
static_assert(sizeof(Tile) == 8);

/// One pass over a picture, to all PEs while none has a tile: which of its pixels' samples the tiles take. The i-th of
/// the pass is sample (first + i) * step modulo camera.samples.
struct View {
  CameraView camera;    ///< samples: as in StageLayout::view, whose sample places and filter hold for it
  std::uint32_t first;  ///< below camera.samples
  std::uint32_t count;  ///< 1 or more; first + count is at most camera.samples
  std::uint32_t step;   ///< 1, or below camera.samples and without a common divisor with it: spreads few samples over
                        ///< the pixel
};
static_assert(sizeof(View) == 108);

struct Grant {
  std::uint32_t credits;
};

struct WorkDone {
  std::uint32_t
      points;  ///< or parts of points, or tiles, finished since the last such message; ray tracing stage: tiles
  std::uint32_t records;  ///< made since
};

struct Credits {
  std::uint32_t count;
};

/// The longest text that a program ends with.
inline constexpr std::uint32_t kMostFaultWords = 512;

/// Reasons for Hint::fail, from pe.elf and from start.S.
enum class FaultCode : std::uint32_t {
  trap = 1,             ///< detail: mcause, mepc, mtval
  protocol_version,     ///< detail: image, emulator
  bad_layout,           ///< detail: see fault_fields.hpp
  outside_store,        ///< detail: see fault_fields.hpp
  unknown_message,      ///< detail: kind
  unexpected_message,   ///< detail: kind, state
  bad_record,           ///< detail: see fault_fields.hpp
  own_slots_exhausted,  ///< detail: slots
  release_list_full,    ///< detail: slots released since the last send or receive
  short_message,        ///< detail: kind, bytes, bytes expected
  words,                ///< detail: address and length of a text that says it all (1..kMostFaultWords); where: pc, or 0
};

}  // namespace torolux::protocol
