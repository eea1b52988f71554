// SPDX-License-Identifier: MIT
// A socket that never blocks for long.
#include "host_tools/growing_picture/viewer_connection.hpp"

#include <netdb.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "emulator/errors.hpp"
#include "host_tools/growing_picture/viewer_messages.hpp"

namespace torolux {
namespace {

constexpr int kSliceMilliseconds = 50;
/// A host that does not answer at all is tried for so long, then again later.
constexpr int kConnectSlices = 20;

/// Whether the socket takes bytes now, after a slice of time at most.
bool writable(int socket) {
  pollfd wait{socket, POLLOUT, 0};
  return ::poll(&wait, 1, kSliceMilliseconds) > 0;
}

std::uint16_t parse_port(const std::string& text) {
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, port);
  if (error != std::errc{} || last != end || port == 0)
    throw UsageError("\"" + text + "\" is no port; there are 1 to 65535, and tev listens at " +
                     std::to_string(kViewerPort));
  return port;
}

}  // namespace

ViewerAddress parse_viewer_address(const std::string& text) {
  ViewerAddress address{text, kViewerPort};
  const std::size_t colon = text.rfind(':');
  const std::size_t bracket = text.rfind(']');
  if (colon != std::string::npos && (bracket == std::string::npos || colon > bracket)) {
    address.host = text.substr(0, colon);
    address.port = parse_port(text.substr(colon + 1));
  }
  if (address.host.starts_with('[') && address.host.ends_with(']'))
    address.host = address.host.substr(1, address.host.size() - 2);
  else if (address.host.find(':') != std::string::npos)
    throw UsageError("\"" + text + "\": an address with colons stands in brackets, like [::1]:14158");
  if (address.host.empty()) throw UsageError("\"" + text + "\" names no host; like localhost:14158");
  return address;
}

ViewerConnection::ViewerConnection(const ViewerAddress& address) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &wanted, &found);
  if (error != 0) throw InputError("--display-server: " + address.host + ": " + ::gai_strerror(error));
  // Of a name that has both kinds, viewers listen at the older one.
  const addrinfo* chosen = found;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next)
    if (one->ai_family == AF_INET) {
      chosen = one;
      break;
    }
  std::memcpy(&address_, chosen->ai_addr, chosen->ai_addrlen);
  length_ = chosen->ai_addrlen;
  ::freeaddrinfo(found);
}

bool ViewerConnection::connect(const std::function<bool()>& give_up) {
  if (open()) return true;
  socket_ = ::socket(address_.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) return false;
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address_), length_) == 0) return true;
  if (errno == EINPROGRESS) {
    for (int slice = 0; slice < kConnectSlices && !give_up(); ++slice) {
      if (!writable(socket_)) continue;
      int error = 0;
      socklen_t size = sizeof error;
      if (::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0) return true;
      break;
    }
  }
  close();
  return false;
}

bool ViewerConnection::send(std::span<const std::byte> bytes, const std::function<bool()>& stalled) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
      continue;
    }
    const bool full = errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    if (full && (writable(socket_) || !stalled())) continue;
    close();
    return false;
  }
  return true;
}

void ViewerConnection::look() {
  std::array<std::byte, 4096> said{};
  while (open()) {
    const ssize_t got = ::recv(socket_, said.data(), said.size(), MSG_DONTWAIT);
    if (got > 0) continue;
    if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (got < 0 && errno == EINTR) continue;
    close();
  }
}

void ViewerConnection::close() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

}  // namespace torolux
