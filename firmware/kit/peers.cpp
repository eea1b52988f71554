// SPDX-License-Identifier: MIT
// The table of peers, on the heap.
#include "firmware/kit/peers.hpp"

#include <new>

namespace torolux::kit {

bool Peers::begin(std::uint32_t pes) {
  // No make_unique of the library tells that memory is out.
  // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): owned at once
  groups_.reset(new (std::nothrow) Block<Group>[(pes + kGroup - 1) / kGroup]);
  return groups_ != nullptr;
}

Peer* Peers::of(std::uint32_t pe) {
  Block<Group>& group = groups_[pe / kGroup];
  if (!group) group = make_block<Group>(0);
  return group ? &(*group)[pe % kGroup] : nullptr;
}

}  // namespace torolux::kit
