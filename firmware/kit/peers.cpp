// SPDX-License-Identifier: MIT
// The table of peers, on the heap.
#include "firmware/kit/peers.hpp"

#include <cstdlib>

namespace torolux::kit {

bool Peers::begin(std::uint32_t pes) {
  count_ = (pes + kGroup - 1) / kGroup;
  groups_ = static_cast<Peer**>(std::calloc(count_, sizeof(Peer*)));
  return groups_ != nullptr;
}

void Peers::end() {
  for (std::uint32_t group = 0; group < count_; ++group) std::free(groups_[group]);
  std::free(groups_);
  groups_ = nullptr;
  count_ = 0;
}

Peer* Peers::of(std::uint32_t pe) {
  Peer*& group = groups_[pe / kGroup];
  if (group == nullptr) group = static_cast<Peer*>(std::calloc(kGroup, sizeof(Peer)));
  return group == nullptr ? nullptr : group + pe % kGroup;
}

}  // namespace torolux::kit
