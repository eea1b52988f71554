// SPDX-License-Identifier: MIT
// One PE's program state, of fixed size; and the handlers in the order in which light meets them.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/niu/niu.hpp"
#include "firmware/pe/outbox.hpp"
#include "firmware/pe/results.hpp"
#include "firmware/pe/scene.hpp"
#include "firmware/pe/shot.hpp"
#include "firmware/pe/tile.hpp"
#include "firmware/pe/traverse.hpp"
#include "firmware/pe/work.hpp"
#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

enum class State : std::uint32_t { empty, configured, running };

/// A possible shot while the best are being chosen; the full Candidate is made when it is sent.
struct Choice {
  std::int64_t unshot;
  std::uint32_t number;  ///< global patch
  std::uint32_t way;     ///< local patch * 4 + side * 2 + (1: reflected)
};
static_assert(sizeof(Choice) == 16);

struct Pe {
  State state = State::empty;
  Scene scene;
  RecordSlots slots;
  Outbox outbox;
  Results results;
  Shot shot;
  Points points;
  Expansion expansion;
  Tiles tiles;
  protocol::WorkDone done{};  ///< not told yet
  Credits credits;
  protocol::Tally tally{};
  protocol::Visits visits{};
  std::array<Choice, protocol::kMostShooters> choices{};
};
/// All that the program keeps outside the stores: part of the image, never of the stores' memory.
static_assert(sizeof(Pe) <= 24U * 1024U);

/// Receives and handles until the host says stop. `pe` is as constructed.
void run_pe(Pe& pe, Niu& niu);

// What run_pe calls stays a function of its own: translated code runs whole functions best from their beginning, and
// run_pe goes on in its middle after each wait.
// ---- Messages (control.cpp) ----
/// Handles the message that has just come. False: it was `stop`.
[[gnu::noinline]] bool handle_message(Pe& pe, Niu& niu);

// ---- Layout (layout.cpp, verify.cpp): fail the run where something does not hold ----
void check_layout(Niu& niu, const protocol::StageLayout& layout);
/// Of the camera rays that the PE makes.
void check_view(Niu& niu, const protocol::StageLayout& layout);
void verify_stores(Niu& niu, const Scene& scene);

// ---- Records ----
/// Checks an arrived record before anything uses it, then follows its light.
[[gnu::noinline]] void handle_radiosity_record(Pe& pe, Niu& niu, Slot slot);
[[gnu::noinline]] void handle_ray(Pe& pe, Niu& niu, Slot slot);
/// Follows a hemi-cube pixel's flux until it leaves this PE or ends (radiosity.cpp).
void follow_light(Pe& pe, Niu& niu, Slot slot);
/// Adds flux to one of this PE's elements (deposit.cpp). apart: as StageLayout::apart says.
void add_to_element(Pe& pe, std::uint32_t patch, std::uint32_t element, std::uint32_t side, bool apart,
                    const protocol::Flux& flux);
/// The light of a record falls on a diffuse or glossy surface: adds it here, or sends it to the element's owner. True:
/// it goes on from here.
bool deposit(Pe& pe, Niu& niu, Slot slot, const Hit& hit);
/// The light of a record has been added to an element of this patch. True: it goes on, by a glossy lobe
/// (radiosity.cpp).
bool leave_element(Pe& pe, Niu& niu, Slot slot, std::uint32_t patch);
/// The record's light has ended: its slot is free, its credit goes home.
void end_record(Pe& pe, Niu& niu, Slot slot);

/// Follows a ray until it leaves this PE or ends (ray_tracing.cpp).
void follow_ray(Pe& pe, Niu& niu, Slot slot);

// ---- Tiles (tile.cpp) ----
/// Tiles from now on are of another pass.
void take_view(Pe& pe, Niu& niu, const protocol::View& view);
/// A tile has been dealt, whose rays are to be made here.
void take_tile(Pe& pe, Niu& niu, const protocol::Tile& tile);
/// Makes up to `most` rays, as far as there are credits in hand.
void make_rays(Pe& pe, Niu& niu, std::uint32_t most);

// ---- Shots (select.cpp, shoot.cpp, expand.cpp) ----
void select_shooters(Pe& pe, Niu& niu, const protocol::Select& select);
void begin_shot(Pe& pe, Niu& niu, const protocol::Shoot& shoot);
/// Makes the next points of the shot, and sends each to its PE.
void deal_points(Pe& pe, Niu& niu, const protocol::Deal& deal);
/// A point has come, to be expanded here.
void take_point(Pe& pe, Niu& niu, const protocol::PointRecord& point);
/// Makes up to `most` records, as far as there are credits in hand.
void expand_points(Pe& pe, Niu& niu, std::uint32_t most);

}  // namespace torolux::pe
