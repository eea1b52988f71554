// SPDX-License-Identifier: MIT
// Payloads that are not on the rank with the network: places in its pool that stand for them while their packets are on
// their way, and hold nothing. A place enters with its packet's name, the name leaves.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "emulator/remote/wire.hpp"
#include "emulator/torus/payload.hpp"

namespace torolux::remote {

/// Nothing in the network looks at such a place: kinds of records are told by their sender, and whether a link's CRC-32
/// sees that a bit has flipped does not depend on what the others are.
class StandIns {
 public:
  void add(Payload* place, const PacketName& name) { names_.insert_or_assign(place, name); }
  /// Nothing: the place holds what it is for.
  std::optional<PacketName> remove(Payload* place) {
    const auto found = names_.find(place);
    if (found == names_.end()) return std::nullopt;
    const PacketName name = found->second;
    names_.erase(found);
    return name;
  }

  using Entry = std::pair<Payload*, PacketName>;
  /// Of those PEs to which packets go. is_meant: is given a PE's number.
  template <class IsMeant>
  std::vector<Entry> all_for(IsMeant is_meant) const {
    std::vector<Entry> entries;
    for (const auto& [place, name] : names_) {
      if (is_meant(name.destination)) entries.emplace_back(place, name);
    }
    return entries;
  }
  /// The payloads have come, one behind the other: each goes where it belongs. False: there are not so many bytes.
  bool fill(const std::vector<Entry>& entries, std::span<const std::byte> payloads) {
    ByteReader reader(payloads);
    for (const auto& [place, name] : entries) {
      if (reader.left() < name.bytes) return false;
      std::ranges::copy(reader.get_bytes(name.bytes), place->bytes.begin());
      names_.erase(place);
    }
    return reader.empty();
  }

 private:
  std::unordered_map<Payload*, PacketName> names_;
};

}  // namespace torolux::remote
