// SPDX-License-Identifier: MIT
// socket, bind, listen.
#include "emulator/engines/qemu/gdb_socket.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

/// The port that the socket has got, or nothing (0): see errno.
std::uint16_t listen_on(int descriptor, std::uint16_t port) {
  const int yes = 1;  // a port that a debugger has just left may be taken again
  setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t bytes = sizeof address;
  auto* plain = reinterpret_cast<sockaddr*>(&address);
  const bool listens =
      bind(descriptor, plain, bytes) == 0 && listen(descriptor, 1) == 0 && getsockname(descriptor, plain, &bytes) == 0;
  return listens ? ntohs(address.sin_port) : std::uint16_t{0};
}

}  // namespace

GdbSocket::GdbSocket(std::uint16_t port) : descriptor_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (descriptor_ >= 0) port_ = listen_on(descriptor_, port);
  if (port_ != 0) return;
  const std::string reason = std::strerror(errno);
  if (descriptor_ >= 0) close(descriptor_);
  throw InputError("no debugger can be awaited on port " + std::to_string(port) + " of 127.0.0.1: " + reason +
                   "; take another port, or 0 for any that is free");
}

GdbSocket::GdbSocket(GdbSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), port_(other.port_) {}

GdbSocket::~GdbSocket() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace torolux
