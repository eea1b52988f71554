// SPDX-License-Identifier: MIT
// Blocks differ by one PE at most.
#include "emulator/remote/placing.hpp"

#include <string>

#include "emulator/errors.hpp"
#include "emulator/nearest_name.hpp"
#include "firmware/protocol/random.hpp"

namespace torolux::remote {

Placing placing_named(std::string_view name) {
  if (name == "block") return Placing::block;
  if (name == "cyclic") return Placing::cyclic;
  if (name == "random") return Placing::random;
  throw UsageError(no_such_name(name, "no way to place PEs on ranks", {"block", "cyclic", "random"}));
}

std::vector<unsigned> place_pes(unsigned pes, unsigned ranks, Placing placing) {
  const unsigned others = ranks - 1;
  std::vector<unsigned> rank_of(pes);
  for (unsigned pe = 0; pe < pes; ++pe) {
    switch (placing) {
      case Placing::block:
        rank_of[pe] = 1 + static_cast<unsigned>(std::uint64_t{pe} * others / pes);
        break;
      case Placing::cyclic:
        rank_of[pe] = 1 + pe % others;
        break;
      case Placing::random:
        rank_of[pe] = 1 + protocol::hash_combine(pe, others) % others;
        break;
    }
  }
  return rank_of;
}

}  // namespace torolux::remote
