// SPDX-License-Identifier: MIT
// Asks each PE for one block after the other, then for its tally; the bytes become fluxes under the mesh's numbers.
#include "host_tools/stages/read_phase.hpp"

#include <algorithm>
#include <utility>

namespace torolux {

using protocol::MessageKind;

ReadPhase::ReadPhase(const Mesh& mesh, const Placement& placement, std::vector<protocol::StageLayout> layouts)
    : mesh_(mesh), placement_(placement), layouts_(std::move(layouts)), bytes_(layouts_.size()) {
  solution_.elements.resize(mesh.elements);
  solution_.sides.resize(mesh.patch_sides);
}

void ReadPhase::start(HostPort& port) {
  for (std::size_t pe = 0; pe < layouts_.size(); ++pe) ask(port, static_cast<PeNumber>(pe));
}

/// Patch sides and elements lie one behind the other.
ReadPhase::Range ReadPhase::range_of(PeNumber pe) const {
  const protocol::StageLayout& layout = layouts_[pe];
  const std::uint32_t end =
      layout.elements.address + layout.elements.count * static_cast<std::uint32_t>(sizeof(protocol::Element));
  return {layout.patch_sides.address, end - layout.patch_sides.address};
}

void ReadPhase::ask(HostPort& port, PeNumber pe) {
  const Range range = range_of(pe);
  const auto have = static_cast<std::uint32_t>(bytes_[pe].size());
  if (have == range.bytes) {
    torolux::send(port, pe, MessageKind::report);
    return;
  }
  const std::uint32_t bytes = std::min(protocol::kMostLoadBytes, range.bytes - have);
  torolux::send(port, pe, MessageKind::read, protocol::Read{range.address + have, bytes});
}

void ReadPhase::on_message(HostPort& port, PeNumber source, MessageKind kind, std::span<const std::byte> contents) {
  if (kind == MessageKind::data) {
    const auto block = contents_as<protocol::LoadBlock>(source, contents);
    const std::uint32_t expected = range_of(source).address + static_cast<std::uint32_t>(bytes_[source].size());
    if (block.address != expected || contents.size() != sizeof block + block.bytes) {
      throw MachineFailure("PE " + std::to_string(source) + " answered a read with another block");
    }
    const auto data = contents.subspan(sizeof block);
    bytes_[source].insert(bytes_[source].end(), data.begin(), data.end());
    ask(port, source);
  } else if (kind == MessageKind::tally) {
    const auto report = contents_as<protocol::StageReport>(source, contents);
    const protocol::Tally& tally = report.tally;
    add_visits(visits_, report.visits);
    protocol::Tally& sum = solution_.tally;
    for (std::size_t c = 0; c < 3; ++c) {
      sum.absorbed_specular[c] += tally.absorbed_specular[c];
      sum.reflected_glossy[c] += tally.reflected_glossy[c];
      sum.escaped[c] += tally.escaped[c];
      sum.cut_off[c] += tally.cut_off[c];
      sum.back_side[c] += tally.back_side[c];
      sum.sky_rest[c] += tally.sky_rest[c];
    }
    sum.rays += tally.rays;
    sum.gather_rays += tally.gather_rays;
    port.work(HostWork::unpack, host_lines(bytes_[source].size()));
    store(source);
    ++done_;
  } else {
    unexpected(source, kind, "reading elements");
  }
}

void ReadPhase::store(PeNumber pe) {
  const protocol::StageLayout& layout = layouts_[pe];
  const std::span<const std::byte> bytes = bytes_[pe];
  const std::size_t elements_at = layout.elements.address - layout.patch_sides.address;
  std::size_t next_side = 0;
  for (const std::uint32_t number : placement_.patches_of_pe[pe]) {
    const MeshPatch& patch = mesh_.patches[number];
    for (std::uint32_t s = 0; s < 2; ++s) {
      if (patch.side[s] == protocol::kNoSide) continue;
      protocol::PatchSide side{};
      std::memcpy(&side, bytes.data() + next_side * sizeof side, sizeof side);
      ++next_side;
      solution_.sides[patch.side[s]] = {side.incident, side.shot, side.emission};
      if (side.first_element + patch.elements > layout.elements.count) {
        throw MachineFailure("PE " + std::to_string(pe) + " has lost a patch's elements");
      }
      for (std::uint32_t e = 0; e < patch.elements; ++e) {
        protocol::Element element{};
        std::memcpy(&element, bytes.data() + elements_at + (side.first_element + e) * sizeof element, sizeof element);
        solution_.elements[patch.first_element[s] + e] = {
            element.flux, element.apart, element.points > 0 ? element.gathered : protocol::Flux{}, element.points};
      }
    }
  }
  bytes_[pe] = {};
}

}  // namespace torolux
