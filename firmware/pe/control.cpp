// SPDX-License-Identifier: MIT
// Messages of the host: set up a stage, start shots, read stores back, stop.
#include <cstddef>
#include <cstring>

#include "firmware/pe/final_gather.hpp"
#include "firmware/pe/pe.hpp"
#include "firmware/protocol/fault_fields.hpp"
#include "firmware/protocol/store_names.hpp"

namespace torolux::pe {
namespace {

using protocol::LoadBlock;
using protocol::MessageKind;

void require(Pe& pe, Niu& niu, bool holds) {
  if (!holds) {
    niu.fail(FaultCode::unexpected_message, niu.message().kind, static_cast<std::uint32_t>(pe.state));
  }
}

/// Only as many entries are sent as there are.
const protocol::Deal& deal_of(Niu& niu) {
  const auto& deal = *reinterpret_cast<const protocol::Deal*>(niu.message_bytes().data());
  const std::uint32_t bytes = niu.message().bytes;
  const bool whole = bytes >= offsetof(protocol::Deal, pe) && deal.count > 0 && deal.count <= protocol::Deal::kMost &&
                     bytes >= offsetof(protocol::Deal, pe) + deal.count * sizeof(PeNumber);
  if (!whole) niu.fail(FaultCode::short_message, niu.message().kind, bytes, sizeof(protocol::Deal));
  return deal;
}

bool makes_rays(const Pe& pe) {
  return pe.state == State::running && !pe.scene.sample_places.empty();
}

bool is_radiosity(const Pe& pe) {
  return pe.state == State::running && pe.scene.layout.stage == protocol::Stage::radiosity;
}

void configure(Pe& pe, Niu& niu) {
  const auto& layout = niu.message_as<protocol::StageLayout>();
  check_layout(niu, layout);
  pe.state = State::configured;
  pe.scene.set(niu.memory(), layout);
  std::memset(static_cast<void*>(pe.scene.elements.data()), 0, pe.scene.elements.size_bytes());
}

void begin(Pe& pe, Niu& niu) {
  verify_stores(niu, pe.scene);
  const protocol::StageLayout& layout = pe.scene.layout;
  if (layout.stage == protocol::Stage::radiosity && gathers(layout)) note_areas(pe.scene);
  pe.slots.set(niu.memory(), layout);
  pe.outbox.set(layout);
  pe.shot = {};
  pe.points = {};
  pe.expansion = {};
  pe.tiles.set(layout);
  pe.done = {};
  pe.credits = {};
  pe.tally = {};
  pe.visits = {};
  niu.set_slots(layout.record_slots.address, protocol::slot_bytes(layout.stage), layout.own_slots,
                layout.record_slots.count - layout.own_slots);
  niu.gather(layout.gather_cycles, layout.gather_records);
  pe.state = State::running;
  niu.send(MessageKind::ready);
}

/// A block must lie in the memory that the image leaves to the stores.
LoadBlock checked_block(Niu& niu) {
  const auto block = niu.message_as<LoadBlock>();
  const std::uint32_t begin = niu.memory().stores_begin();
  const std::uint32_t end = niu.memory_end();
  const bool fits = block.bytes > 0 && block.bytes <= protocol::kMostLoadBytes && block.bytes % 4U == 0 &&
                    block.address % 4U == 0 && block.address >= begin && block.address < end &&
                    block.bytes <= end - block.address;
  if (!fits) {
    niu.fail(FaultCode::outside_store, static_cast<std::uint32_t>(protocol::StoreIndex::load_block), block.address,
             block.bytes);
  }
  return block;
}

void load(Niu& niu) {
  const PhaseMark<Phase::load> mark(niu);
  const LoadBlock block = checked_block(niu);
  const auto bytes = niu.message_bytes();
  if (bytes.size() < sizeof(LoadBlock) + block.bytes) {
    niu.fail(FaultCode::short_message, niu.message().kind, static_cast<std::uint32_t>(bytes.size()),
             sizeof(LoadBlock) + block.bytes);
  }
  std::memcpy(niu.memory().at<std::byte>(block.address), bytes.data() + sizeof(LoadBlock), block.bytes);
}

/// Textures of half a word's length end a store at no multiple of 4: what lies behind it is padding.
void load_store(Pe& pe, Niu& niu) {
  const PhaseMark<Phase::load> mark(niu);
  const auto block = niu.message_as<protocol::LoadStore>();
  const auto bytes = niu.message_bytes();
  const auto extents = protocol::store_extents(pe.scene.layout);
  const auto slots = static_cast<std::uint32_t>(protocol::StoreName::record_slots);
  bool fits = block.store < extents.size() && block.store != slots && block.offset % 4U == 0 && block.bytes % 4U == 0 &&
              block.bytes <= protocol::kMostLoadStoreBytes;
  const std::uint64_t room = fits ? (extents[block.store].bytes() + 3U) / 4U * 4U : 0;
  fits = fits && block.offset <= room && block.bytes <= room - block.offset;
  if (!fits) {
    niu.fail(FaultCode::outside_store, static_cast<std::uint32_t>(protocol::StoreIndex::load_offset), block.offset,
             block.bytes);
  }
  if (bytes.size() < sizeof block + block.bytes) {
    niu.fail(FaultCode::short_message, niu.message().kind, static_cast<std::uint32_t>(bytes.size()),
             sizeof block + block.bytes);
  }
  std::memcpy(niu.memory().at<std::byte>(extents[block.store].store.address) + block.offset,
              bytes.data() + sizeof block, block.bytes);
}

void read(Pe& pe, Niu& niu) {
  const LoadBlock block = checked_block(niu);
  pe.results.flush_pixels(niu);  // the buffer is theirs while there are any
  MessageBuffer& answer = niu.batch();
  answer.header.kind = static_cast<std::uint16_t>(MessageKind::data);
  answer.header.bytes = sizeof(LoadBlock) + block.bytes;
  *answer.as<LoadBlock>() = block;
  std::memcpy(answer.bytes.data() + sizeof(LoadBlock), niu.memory().at<std::byte>(block.address), block.bytes);
  niu.send_message(protocol::kHost, answer.header);
}

}  // namespace

bool handle_message(Pe& pe, Niu& niu) {
  const PhaseMark<Phase::control> mark(niu);
  switch (static_cast<MessageKind>(niu.message().kind)) {
    case MessageKind::configure:
      require(pe, niu, pe.outbox.empty() && !pe.shot.active);
      configure(pe, niu);
      return true;
    case MessageKind::load:
      require(pe, niu, pe.state != State::running);
      load(niu);
      return true;
    case MessageKind::load_store:
      require(pe, niu, pe.state == State::configured);
      load_store(pe, niu);
      return true;
    case MessageKind::begin:
      require(pe, niu, pe.state == State::configured);
      begin(pe, niu);
      return true;
    case MessageKind::select:
      require(pe, niu, is_radiosity(pe));
      select_shooters(pe, niu, niu.message_as<protocol::Select>());
      pe.credits.homewards = false;
      return true;
    case MessageKind::shoot:
      require(pe, niu, is_radiosity(pe) && !pe.shot.active);
      begin_shot(pe, niu, niu.message_as<protocol::Shoot>());
      return true;
    case MessageKind::deal:
      require(pe, niu, is_radiosity(pe) && pe.shot.active);
      deal_points(pe, niu, deal_of(niu));
      return true;
    case MessageKind::tile:
      require(pe, niu, makes_rays(pe));
      take_tile(pe, niu, niu.message_as<protocol::Tile>());
      return true;
    case MessageKind::view:
      require(pe, niu, makes_rays(pe) && pe.tiles.held == 0);
      take_view(pe, niu, niu.message_as<protocol::View>());
      return true;
    case MessageKind::grant:
      require(pe, niu, pe.state == State::running);
      pe.credits.in_hand += niu.message_as<protocol::Grant>().credits;
      pe.credits.asked = false;
      return true;
    case MessageKind::recall:
      require(pe, niu, pe.state == State::running);
      pe.credits.homewards = true;
      return true;
    case MessageKind::read:
      read(pe, niu);
      return true;
    case MessageKind::report:
      niu.send(MessageKind::tally, protocol::StageReport{pe.tally, pe.visits});
      return true;
    case MessageKind::stop:
      return false;
    default:
      niu.fail(FaultCode::unknown_message, niu.message().kind);
  }
}

}  // namespace torolux::pe
