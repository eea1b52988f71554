// SPDX-License-Identifier: MIT
// PEs with fake NIUs: HINTs in, queues of packets and messages out. Checks what firmware owes the NIU.
#include "tests/unit/firmware/pe/fake_machine.hpp"

#include <cstring>
#include <string>

#include "firmware/protocol/shot_grid.hpp"

namespace torolux::test {
namespace {

using protocol::Hint;
using protocol::MessageKind;

struct Asleep {};
struct Halted {};

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(std::string("firmware broke the NIU's rules: ") + what);
}

std::uint32_t round_up(std::uint32_t value, std::uint32_t to) {
  return (value + to - 1) / to * to;
}

}  // namespace

PeFailed::PeFailed(const protocol::Fault& f)
    : std::runtime_error("PE failed: code " + std::to_string(f.code) + ", " + std::to_string(f.detail[0]) + " " +
                         std::to_string(f.detail[1]) + " " + std::to_string(f.detail[2])),
      fault(f) {}

FakePe::FakePe(FakeMachine& machine, std::uint16_t number, std::uint16_t pes, std::uint32_t local_memory_bytes)
    : machine_(machine),
      number_(number),
      bytes_(local_memory_bytes),
      memory_(std::make_unique<std::byte[]>(local_memory_bytes)),
      page_(new (memory_.get()) pe::NiuPage{}),
      niu_(*page_, pe::Memory(pe::LocalBase(memory_.get(), stores_begin())), pe::HintGate(*this)) {
  window().pe = number;
  window().columns = pes;
  window().rows = 1;
  window().local_memory_bytes = local_memory_bytes;
}

std::uint32_t FakePe::stores_begin() const {
  return protocol::kLocalMemoryBase + protocol::kPageBytes;
}

void FakePe::work() {
  if (halted_) return;
  try {
    pe::run_pe(*pe_, niu_);
    halted_ = true;
  } catch (const Asleep&) {  // it goes on at the next call
  } catch (const Halted&) {
    halted_ = true;
  }
}

void FakePe::hint(std::int32_t immediate) {
  switch (static_cast<Hint>(immediate)) {
    case Hint::send_records:
      return send_records();
    case Hint::send_message:
      return send_message();
    case Hint::receive:
      return receive(true);
    case Hint::receive_if_any:
    case Hint::receive_more:
    case Hint::receive_due:
      return receive(false);
    case Hint::set_slots:
      return set_slots();
    case Hint::halt:
      throw Halted{};
    case Hint::fail:
      throw PeFailed(window().fault);
    default:  // markers
      return;
  }
}

std::byte* FakePe::slot(std::uint16_t number) {
  require(number < slots_.own + slots_.niu, "slot number");
  return memory_.get() + (slots_.address - protocol::kLocalMemoryBase) + std::size_t{number} * slots_.bytes;
}

void FakePe::release() {
  for (std::uint32_t i = 0; i < window().released; ++i) {
    const std::uint16_t s = window().release[i];
    require(s >= slots_.own && s < slots_.own + slots_.niu && in_use_[s], "released a slot that it did not have");
    in_use_[s] = false;
    free_.push_back(s);
  }
  window().released = 0;
}

void FakePe::receive(bool wait) {
  release();
  auto& arrival = window().arrival;
  arrival.kind = protocol::ArrivalKind::none;
  if (arrivals_.empty()) {
    if (wait) throw Asleep{};
    return;
  }
  const Item item = std::move(arrivals_.front());
  arrivals_.pop_front();
  if (item.message.empty() && !item.slots.empty()) {
    arrival.kind = protocol::ArrivalKind::records;
    arrival.source = item.source;
    arrival.count = static_cast<std::uint16_t>(item.slots.size());
    std::copy(item.slots.begin(), item.slots.end(), arrival.slots.begin());
    return;
  }
  arrival.kind = protocol::ArrivalKind::message;
  window().message = {item.kind, item.source, static_cast<std::uint32_t>(item.message.size())};
  if (!item.message.empty()) std::memcpy(window().message_bytes.data(), item.message.data(), item.message.size());
}

void FakePe::set_slots() {
  require(free_.size() == slots_.niu, "slots set while some are in use");
  slots_ = window().slots;
  free_.clear();
  in_use_.assign(slots_.own + slots_.niu, false);
  for (std::uint32_t s = slots_.own + slots_.niu; s-- > slots_.own;) free_.push_back(static_cast<std::uint16_t>(s));
}

void FakePe::send_records() {
  release();
  const auto& out = window().send;
  require(out.count >= 1 && out.count * slots_.bytes <= protocol::kMostPacketBytes && out.count <= 16, "packet size");
  require(out.destination < machine_.pes.size() && out.destination != number_, "packet's destination");
  Packet packet{number_, out.destination, {}};
  for (std::uint32_t i = 0; i < out.count; ++i) {
    const std::uint16_t s = out.slots[i];
    packet.records.emplace_back(slot(s), slot(s) + slots_.bytes);
    if (s < slots_.own) continue;
    require(in_use_[s], "sent a slot that it did not have");
    in_use_[s] = false;
    free_.push_back(s);
  }
  machine_.records_sent += out.count;
  machine_.largest_packet = std::max<std::uint64_t>(machine_.largest_packet, out.count);
  machine_.torus.push_back(std::move(packet));
}

void FakePe::send_message() {
  release();
  const auto& out = window().send;
  const std::byte* from = memory_.get() + (out.address - protocol::kLocalMemoryBase);
  protocol::MessageHeader header{};
  std::memcpy(&header, from, sizeof(header));
  require(header.bytes <= protocol::kMostMessageBytes, "message size");
  from += sizeof(header);
  if (out.destination == protocol::kHost) {
    machine_.to_host.push_back({number_, static_cast<MessageKind>(header.kind), {from, from + header.bytes}});
    return;
  }
  require(out.destination == protocol::kFrameBuffer, "message's destination");
  require(header.kind == static_cast<std::uint16_t>(protocol::MachineMessage::pixels), "kind of pixel message");
  std::vector<protocol::PixelAdd> adds(header.bytes / sizeof(protocol::PixelAdd));
  std::memcpy(adds.data(), from, header.bytes);
  for (const auto& add : adds) {
    auto& plane = add.plane == protocol::Plane::colour ? machine_.pixels : machine_.layers[add.plane];
    for (std::size_t c = 0; c < 3; ++c) plane[add.pixel][c] += add.value[c];
  }
}

bool FakePe::take(const Packet& packet) {
  if (free_.size() < packet.records.size()) return false;
  Item item{packet.source, {}, 0, {}};
  for (const auto& record : packet.records) {
    const std::uint16_t s = free_.back();
    free_.pop_back();
    in_use_[s] = true;
    std::memcpy(slot(s), record.data(), record.size());
    item.slots.push_back(s);
  }
  arrivals_.push_back(std::move(item));
  return true;
}

void FakePe::take_message(std::uint16_t kind, std::span<const std::byte> bytes) {
  arrivals_.push_back({protocol::kHost, {}, kind, {bytes.begin(), bytes.end()}});
}

void FakePe::write(std::uint32_t address, std::span<const std::byte> bytes) {
  std::copy(bytes.begin(), bytes.end(), memory_.get() + (address - protocol::kLocalMemoryBase));
}

std::span<const std::byte> FakePe::at(std::uint32_t address, std::size_t bytes) const {
  return {memory_.get() + (address - protocol::kLocalMemoryBase), bytes};
}

FakeMachine::FakeMachine(std::uint32_t count, std::uint32_t local_memory_bytes) {
  for (std::uint32_t p = 0; p < count; ++p) {
    pes.push_back(std::make_unique<FakePe>(*this, static_cast<std::uint16_t>(p), static_cast<std::uint16_t>(count),
                                           local_memory_bytes));
  }
}

void FakeMachine::message(std::uint16_t pe, MessageKind kind, std::span<const std::byte> bytes) {
  pes[pe]->take_message(static_cast<std::uint16_t>(kind), bytes);
}

void FakeMachine::run() {
  for (;;) {
    for (auto& pe : pes) pe->work();
    if (torus.empty()) return;
    std::deque<Packet> now;
    now.swap(torus);
    for (Packet& packet : now) {
      if (!pes[packet.destination]->take(packet)) torus.push_back(std::move(packet));
    }
  }
}

void FakeMachine::load_bytes(std::uint16_t pe, std::uint32_t address, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const auto part = static_cast<std::uint32_t>(std::min<std::size_t>(bytes.size(), protocol::kMostLoadBytes));
    std::vector<std::byte> block(sizeof(protocol::LoadBlock) + part);
    const protocol::LoadBlock head{address, part};
    std::memcpy(block.data(), &head, sizeof(head));
    std::memcpy(block.data() + sizeof(head), bytes.data(), part);
    message(pe, MessageKind::load, std::span<const std::byte>(block));
    address += part;
    bytes = bytes.subspan(part);
  }
}

void FakeMachine::load_stores(std::uint16_t pe, std::uint32_t niu_slots) {
  PeStores& s = stores[pe];
  std::uint32_t next = pes[pe]->stores_begin();
  std::vector<std::pair<std::uint32_t, std::span<const std::byte>>> blocks;
  const auto place = [&](protocol::Store& store, const auto& items) {
    store = {next, static_cast<std::uint32_t>(items.size())};
    blocks.emplace_back(next, std::as_bytes(std::span(items)));
    next = round_up(next + static_cast<std::uint32_t>(blocks.back().second.size()), 8);
  };
  protocol::StageLayout& l = s.layout;
  place(l.cell_words, s.cell_words);
  place(l.cell_entries, s.cell_entries);
  place(l.subspaces, s.subspaces);
  place(l.polygon_list, s.polygon_list);
  place(l.polygons, s.polygons);
  place(l.materials, s.materials);
  place(l.normals, s.normals);
  place(l.nodes, s.nodes);
  place(l.patch_references, s.references);
  place(l.patch_parts, s.parts);
  place(l.patches, s.patches);
  place(l.patch_sides, s.sides);
  place(l.elements, s.elements);
  place(l.facets, s.facets);
  place(l.hemicube, s.hemicube);
  place(l.irradiance, s.irradiance);
  place(l.kept, s.kept);
  place(l.textures, s.textures);
  place(l.texels, s.texels);
  place(l.texture_points, s.texture_points);
  place(l.sample_places, s.sample_places);
  place(l.filter, s.filter);
  place(l.emitters, s.emitters);
  place(l.sky, s.sky);
  place(l.sky_openings, s.sky_openings);
  place(l.lamps, s.lamps);
  place(l.lamp_values, s.lamp_values);
  place(l.lamp_chances, s.lamp_chances);
  l.record_slots = {next, l.own_slots + niu_slots};
  message(pe, MessageKind::configure, l);
  for (const auto& [address, bytes] : blocks) load_bytes(pe, address, bytes);
}

void FakeMachine::begin(const TestScene& scene, protocol::Stage stage, std::uint32_t niu_slots,
                        float irradiance_value) {
  load(scene, stage, niu_slots, irradiance_value, [](PeStores&) {});
  for (std::uint16_t p = 0; p < pes.size(); ++p) message(p, MessageKind::begin);
  run();
  require(take(MessageKind::ready).size() == pes.size(), "not all PEs are ready");
}

std::vector<HostMessage> FakeMachine::take(MessageKind kind) {
  std::vector<HostMessage> out;
  std::erase_if(to_host, [&](const HostMessage& m) {
    if (m.kind == kind) out.push_back(m);
    return m.kind == kind;
  });
  return out;
}

std::uint32_t FakeMachine::take_credits() {
  std::uint32_t sum = 0;
  for (const HostMessage& m : take(MessageKind::credits)) sum += m.as<protocol::Credits>().count;
  return sum;
}

std::uint32_t FakeMachine::points_of(std::uint16_t pe, const protocol::Shoot& shoot) const {
  if (shoot.kind == protocol::ShotKind::gathering) return static_cast<std::uint32_t>(shoot.amount[0]);
  const protocol::StageLayout& l = stores[pe].layout;
  protocol::Flux flux = shoot.amount;
  if (shoot.kind == protocol::ShotKind::reflected) {
    for (std::size_t c = 0; c < 3; ++c) {
      flux[c] = protocol::scale_down(flux[c], stores[pe].patches[shoot.patch].reflectance[c]);
    }
  }
  return protocol::points_of_shot(shoot.kind, flux, l.points_per_quantum, l.shot_points, l.emission_points);
}

void FakeMachine::deal(std::uint16_t owner, std::span<const std::uint16_t> to, std::uint32_t in_parts) {
  protocol::Deal deal{static_cast<std::uint32_t>(to.size()), in_parts, {}};
  std::copy(to.begin(), to.end(), deal.pe.begin());
  message(owner, MessageKind::deal,
          std::as_bytes(std::span(&deal, 1)).first(offsetof(protocol::Deal, pe) + to.size_bytes()));
}

std::uint32_t FakeMachine::grant_to_all_in_need(std::uint32_t credits) {
  std::vector<bool> asked(pes.size());
  std::uint32_t granted = 0;
  for (const HostMessage& m : take(MessageKind::need)) {
    require(!asked[m.source], "asked for credits twice");
    asked[m.source] = true;
    message(m.source, MessageKind::grant, protocol::Grant{credits});
    granted += credits;
  }
  for (std::size_t p = 0; p < pes.size(); ++p) {
    require(asked[p] || !pe::has_work(pes[p]->state()), "asleep without credits, and not asked for any");
  }
  return granted;
}

std::uint32_t FakeMachine::shoot(std::uint16_t owner, const protocol::Shoot& shoot, std::uint32_t credits) {
  const std::uint64_t before = rays();
  message(owner, MessageKind::shoot, shoot);
  const std::uint32_t pieces = points_of(owner, shoot) * shoot_in_parts;
  std::vector<std::uint32_t> supplied(pes.size());
  std::uint32_t dealt = 0;
  protocol::WorkDone done{};
  while (done.points < pieces) {
    std::vector<std::uint16_t> to;
    while (dealt < pieces && to.size() < protocol::Deal::kMost) {
      const auto next = static_cast<std::uint16_t>(points_travel ? (owner + dealt) % pes.size() : owner);
      if (supplied[next] == protocol::kPointPlaces) break;
      ++supplied[next];
      to.push_back(next);
      ++dealt;
    }
    if (!to.empty()) deal(owner, to, shoot_in_parts);
    run();
    const std::uint32_t granted = grant_to_all_in_need(credits);
    run();
    require(take_credits() == granted, "credits lost or made");
    for (const auto& p : pes) require(p->free_niu_slots() == p->niu_slots(), "record slots lost");
    const auto finished = take(MessageKind::work_done);
    require(!to.empty() || granted > 0 || !finished.empty(), "all asleep, and not all points are done");
    for (const HostMessage& m : finished) {
      const auto part = m.as<protocol::WorkDone>();
      require(part.points <= supplied[m.source], "more points done than dealt");
      supplied[m.source] -= part.points;
      done.points += part.points;
      done.records += part.records;
    }
  }
  // Who asked may have finished with the credits of records that died there since.
  const std::uint32_t granted = grant_to_all_in_need(credits);
  run();
  require(take_credits() == granted, "credits kept without work");
  require(take(MessageKind::need).empty(), "asked for credits without work");
  require(rays() - before == done.records, "records made and not told of");
  return done.records;
}

std::uint64_t FakeMachine::rays() {
  std::uint64_t sum = 0;
  for (std::uint16_t p = 0; p < pes.size(); ++p) {
    const protocol::Tally made = tally(p);
    sum += made.rays + made.gather_rays;
  }
  return sum;
}

std::vector<protocol::Candidate> FakeMachine::select(std::uint16_t pe, std::uint32_t count, std::int64_t threshold) {
  message(pe, MessageKind::select, protocol::Select{count, 0, threshold});
  message(pe, MessageKind::recall);
  run();
  std::vector<protocol::Candidate> out;
  const auto messages = take(MessageKind::candidates);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto part = messages[i].as<protocol::Candidates>();
    require(part.last == (i + 1 == messages.size() ? 1U : 0U), "last candidates not marked");
    out.insert(out.end(), part.candidate.begin(), part.candidate.begin() + part.count);
  }
  return out;
}

protocol::Tally FakeMachine::tally(std::uint16_t pe) {
  message(pe, MessageKind::report);
  run();
  return take(MessageKind::tally).at(0).as<protocol::Tally>();
}

void FakeMachine::stop() {
  for (std::uint16_t p = 0; p < pes.size(); ++p) message(p, MessageKind::stop);
  run();
  for (const auto& pe : pes) require(pe->halted(), "a PE did not stop");
}

}  // namespace torolux::test
