// SPDX-License-Identifier: MIT
// A name enters; the address of a local socket of that name, which is no file, leaves: the same for who listens there
// and who connects.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <cstddef>
#include <cstring>
#include <optional>
#include <string_view>

namespace torolux::ranks {

struct AbstractAddress {
  sockaddr_un local{};
  socklen_t bytes = 0;

  const sockaddr* any() const { return reinterpret_cast<const sockaddr*>(&local); }
};

/// None: the name is too long.
inline std::optional<AbstractAddress> abstract_address(std::string_view name) {
  AbstractAddress address;
  address.local.sun_family = AF_UNIX;
  if (name.size() >= sizeof(address.local.sun_path)) return std::nullopt;
  std::memcpy(&address.local.sun_path[1], name.data(), name.size());  // the first byte is 0: abstract
  address.bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return address;
}

}  // namespace torolux::ranks
