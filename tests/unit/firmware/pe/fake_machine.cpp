// SPDX-License-Identifier: MIT
// The machine around fake PEs: packets carried, stores loaded, points dealt and credits granted as a host would. Checks
// what PEs owe their host.
#include "tests/unit/firmware/pe/fake_machine.hpp"

#include <cstring>

#include "firmware/protocol/shot_grid.hpp"
#include "tests/unit/firmware/pe/niu_rules.hpp"

namespace torolux::test {
namespace {

using protocol::MessageKind;

std::uint32_t round_up(std::uint32_t value, std::uint32_t to) {
  return (value + to - 1) / to * to;
}

}  // namespace

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
