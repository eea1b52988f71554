// SPDX-License-Identifier: MIT
// Messages with credits enter; grants leave: the same to all PEs, a share to one, or to those that have asked, first
// come, first served. Counts how many are at home.
#include "host_tools/stages/credit_pool.hpp"

#include <algorithm>

namespace torolux {

void CreditPool::take_home(HostPort& port, PeNumber source, std::span<const std::byte> contents) {
  port.work(HostWork::entry, 1);
  home_ += contents_as<protocol::Credits>(source, contents).count;
  if (home_ > credits_)
    throw MachineFailure("with those of PE " + std::to_string(source) + ", " + std::to_string(home_) +
                         " credits came home; there are " + std::to_string(credits_));
}

bool CreditPool::grant_all(HostPort& port) {
  const std::uint64_t each = home_ / pes_ / 2;
  if (each == 0) return false;
  port.work(HostWork::entry, 1);
  home_ -= each * pes_;
  const protocol::Grant grant{static_cast<std::uint32_t>(each)};
  port.broadcast(static_cast<std::uint16_t>(protocol::MessageKind::grant), std::as_bytes(std::span(&grant, 1)));
  return true;
}

void CreditPool::grant_share(HostPort& port, PeNumber pe) {
  if (home_ > 0) grant(port, pe, std::max<std::uint64_t>(1, credits_ / pes_));
}

void CreditPool::ask(HostPort& port, PeNumber pe) {
  hungry_.push_back(pe);
  feed(port);
}

void CreditPool::feed(HostPort& port) {
  while (home_ > 0 && !hungry_.empty()) {
    const PeNumber pe = hungry_.front();
    hungry_.pop_front();
    grant(port, pe, std::max<std::uint64_t>(1, credits_ / pes_ / 2));
  }
  note(port);
}

void CreditPool::note(HostPort& port) const {
  port.note(HostGauge::records_in_flight, static_cast<double>(credits_ - home_));
}

void CreditPool::grant(HostPort& port, PeNumber pe, std::uint64_t credits) {
  port.work(HostWork::entry, 1);
  const auto granted = static_cast<std::uint32_t>(std::min(credits, home_));
  home_ -= granted;
  send(port, pe, protocol::MessageKind::grant, protocol::Grant{granted});
}

}  // namespace torolux
