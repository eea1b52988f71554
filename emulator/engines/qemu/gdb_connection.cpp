// SPDX-License-Identifier: MIT
// Packets are "$contents#checksum"; each is acknowledged by "+".
#include "emulator/engines/qemu/gdb_connection.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

/// A thousand processes may share one core.
constexpr int kLongestSilenceMs = 120'000;

std::string hex(std::uint32_t value, int digits) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%0*x", digits, value);
  return text.data();
}

std::uint32_t swapped(std::uint32_t value) {
  return __builtin_bswap32(value);
}

[[noreturn]] void fail(const std::string& what) {
  throw MachineFailure("a PE's QEMU " + what);
}

}  // namespace

GdbConnection::GdbConnection() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    fail(std::string("cannot be spoken to: ") + std::strerror(errno));
  ours_ = ends[0];
  qemus_ = ends[1];
}

GdbConnection::GdbConnection(GdbConnection&& other) noexcept
    : ours_(std::exchange(other.ours_, -1)),
      qemus_(std::exchange(other.qemus_, -1)),
      received_(std::move(other.received_)) {}

GdbConnection::~GdbConnection() {
  leave_to_qemu();
  if (ours_ >= 0) close(ours_);
}

void GdbConnection::leave_to_qemu() {
  if (qemus_ >= 0) close(qemus_);
  qemus_ = -1;
}

void GdbConnection::send_bytes(const std::string& bytes) const {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t now = ::send(ours_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) fail("has ended");
    sent += static_cast<std::size_t>(now);
  }
}

void GdbConnection::send(const std::string& command) {
  std::uint32_t sum = 0;
  for (const char c : command) sum += static_cast<std::uint8_t>(c);
  send_bytes("$" + command + "#" + hex(sum & 0xFFU, 2));
}

char GdbConnection::next() {
  while (received_.empty()) {
    pollfd waits{ours_, POLLIN, 0};
    const int ready = poll(&waits, 1, kLongestSilenceMs);
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) fail("does not answer its debugger");
    std::array<char, 4096> bytes{};
    const ssize_t read = recv(ours_, bytes.data(), bytes.size(), 0);
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) fail("has ended");
    received_.assign(bytes.data(), static_cast<std::size_t>(read));
  }
  const char c = received_.front();
  received_.erase(0, 1);
  return c;
}

std::string GdbConnection::reply() {
  while (next() != '$') {
  }
  std::string contents;
  for (char c = next(); c != '#'; c = next()) contents += c;
  next();  // the checksum; a socket between two processes of one computer loses nothing
  next();
  send_bytes("+");
  return contents;
}

std::string GdbConnection::ask(const std::string& command) {
  send(command);
  return reply();
}

void GdbConnection::interrupt() {
  send_bytes("\x03");
  reply();
}

std::uint32_t GdbConnection::read(unsigned number) {
  const std::string text = ask("p" + hex(number, 1));
  unsigned value = 0;
  if (text.size() != 8 || std::sscanf(text.c_str(), "%8x", &value) != 1)
    fail("has no register " + std::to_string(number) + ": " + text);
  return swapped(value);
}

void GdbConnection::write(unsigned number, std::uint32_t value) {
  const std::string text = ask("P" + hex(number, 1) + "=" + hex(swapped(value), 8));
  if (text != "OK") fail("does not let register " + std::to_string(number) + " be set: " + text);
}

}  // namespace torolux
