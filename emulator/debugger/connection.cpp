// SPDX-License-Identifier: MIT
// poll, accept, recv, send.
#include "emulator/debugger/connection.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace torolux::debugger {
namespace {

constexpr std::chrono::milliseconds kFarewell{500};

}  // namespace

Connection::~Connection() {
  close();
}

/// What is still unread when a line is closed would take with it what has been sent: the other side closes first, or
/// has had its time.
void Connection::close() {
  if (line_ >= 0) {
    shutdown(line_, SHUT_WR);
    std::array<char, 256> unread{};
    while (await(line_, kFarewell) && recv(line_, unread.data(), unread.size(), 0) > 0) {
    }
    ::close(line_);
  }
  line_ = -1;
  ended_ = true;
}

bool Connection::await(int descriptor, std::chrono::milliseconds longest) {
  pollfd waits{descriptor, POLLIN, 0};
  return poll(&waits, 1, static_cast<int>(longest.count())) > 0;
}

std::optional<PacketReader::Item> Connection::next(std::chrono::milliseconds longest) {
  if (ended_) return std::nullopt;
  if (line_ < 0) {
    if (!await(socket_.descriptor(), longest)) return std::nullopt;
    line_ = accept4(socket_.descriptor(), nullptr, nullptr, SOCK_CLOEXEC);
    if (line_ < 0) return std::nullopt;
    const int yes = 1;  // fails on a socket of a folder, which needs none of it
    setsockopt(line_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  }
  auto item = reader_.next();
  if (!item && await(line_, longest)) {
    receive();
    item = reader_.next();
  }
  using enum PacketReader::Item::Kind;
  for (; item; item = reader_.next()) {
    if (item->kind == repeat) {
      send_bytes(last_);
    } else if (item->kind == damaged) {
      send_bytes("-");
    } else {
      if (item->kind == packet && acknowledged_) send_bytes("+");
      return item;
    }
  }
  return std::nullopt;
}

void Connection::receive() {
  std::array<char, 4096> bytes{};
  const ssize_t count = recv(line_, bytes.data(), bytes.size(), 0);
  if (count < 0 && errno == EINTR) return;
  if (count <= 0) return close();
  reader_.take({bytes.data(), static_cast<std::size_t>(count)});
}

void Connection::send(const std::string& contents) {
  last_ = framed(contents);
  send_bytes(last_);
}

void Connection::send_bytes(const std::string& bytes) {
  std::size_t sent = 0;
  while (line_ >= 0 && sent < bytes.size()) {
    const ssize_t now = ::send(line_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) return close();
    sent += static_cast<std::size_t>(now);
  }
}

}  // namespace torolux::debugger
