// SPDX-License-Identifier: MIT
// Packets of the protocol: $contents#checksum, acknowledged by '+'.
#include "tests/machine/gdb_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <string_view>

namespace torolux::test {

GdbClient::GdbClient(std::uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  wait_at_most_ten_seconds();
  const int yes = 1;
  setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(socket_);
    throw std::runtime_error("nobody listens on port " + std::to_string(port));
  }
}

GdbClient::GdbClient(const std::filesystem::path& path) : socket_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  wait_at_most_ten_seconds();
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.string().copy(std::begin(address.sun_path), sizeof address.sun_path - 1);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(socket_);
    throw std::runtime_error("nobody listens at " + path.string());
  }
}

void GdbClient::wait_at_most_ten_seconds() const {
  const timeval longest{10, 0};
  setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &longest, sizeof longest);
}

GdbClient::~GdbClient() {
  close(socket_);
}

std::optional<char> GdbClient::next() {
  char c = 0;
  ssize_t count = 0;
  do {
    count = recv(socket_, &c, 1, 0);
  } while (count < 0 && errno == EINTR);
  return count == 1 ? std::optional(c) : std::nullopt;
}

void GdbClient::send(const std::string& command) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  unsigned sum = 0;
  for (const char c : command) sum += static_cast<unsigned char>(c);
  const std::string packet = "$" + command + "#" + kDigits[(sum >> 4U) & 15U] + kDigits[sum & 15U];
  if (::send(socket_, packet.data(), packet.size(), MSG_NOSIGNAL) < 0) throw std::runtime_error("cannot send");
}

std::optional<std::string> GdbClient::reply() {
  std::optional<char> c = next();
  while (c && *c != '$') c = next();
  std::string text;
  for (c = next(); c && *c != '#'; c = next()) text += *c;
  if (!c || !next() || !next()) return std::nullopt;  // the checksum: TCP has its own
  if (::send(socket_, "+", 1, MSG_NOSIGNAL) < 0) return std::nullopt;
  return text;
}

std::optional<std::string> GdbClient::ask(const std::string& command) {
  send(command);
  return reply();
}

void GdbClient::interrupt() {
  const char control_c = 3;
  if (::send(socket_, &control_c, 1, MSG_NOSIGNAL) < 0) throw std::runtime_error("cannot send");
}

std::array<std::uint32_t, 33> GdbClient::registers() {
  std::array<std::uint32_t, 33> values{};
  const std::string text = ask("g").value_or("");
  if (text.size() < 8 * values.size()) throw std::runtime_error("no registers: " + text);
  for (std::size_t i = 0; i < values.size(); ++i) {
    // Bytes in the order of memory, the lowest first.
    values[i] = __builtin_bswap32(static_cast<std::uint32_t>(std::stoul(text.substr(8 * i, 8), nullptr, 16)));
  }
  return values;
}

}  // namespace torolux::test
