// SPDX-License-Identifier: MIT
// epoll tells of connections in the order in which something happened to them. That matters: launchers end all ranks
// where one is lost, so the first that has died is the one that was (emulator/ranks/starter.cpp).
#include "host_tools/launch/rank_links.hpp"

#include <sys/epoll.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "emulator/ranks/abstract_address.hpp"
#include "emulator/ranks/starter.hpp"

namespace torolux::launch {
namespace {

[[noreturn]] void fail(int error) {
  throw std::system_error(error, std::generic_category(), "a socket for ranks");
}

/// Nobody else has it, and nobody guesses it.
std::string random_name() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) fail(errno);
  std::string name = "torolux-";
  for (const unsigned char byte : bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    name += kDigits[byte >> 4U];
    name += kDigits[byte & 15U];
  }
  return name;
}

void watch(int events, int descriptor) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.fd = descriptor;
  if (::epoll_ctl(events, EPOLL_CTL_ADD, descriptor, &event) != 0) fail(errno);
}

RankEvent::Kind kind_of(ranks::StarterWord::Kind kind) {
  if (kind == ranks::StarterWord::Kind::begins) return RankEvent::Kind::begins;
  return kind == ranks::StarterWord::Kind::ends ? RankEvent::Kind::ends : RankEvent::Kind::died;
}

}  // namespace

RankLinks::RankLinks()
    : name_(random_name()),
      socket_(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)),
      events_(::epoll_create1(EPOLL_CLOEXEC)) {
  const ranks::AbstractAddress address = ranks::abstract_address(name_).value();
  if (::bind(socket_, address.any(), address.bytes) != 0 || ::listen(socket_, SOMAXCONN) != 0) fail(errno);
  watch(events_, socket_);
}

RankLinks::~RankLinks() {
  for (const auto& [connection, link] : links_) ::close(connection);
  ::close(events_);
  ::close(socket_);
}

void RankLinks::wake_by(int descriptor) const {
  watch(events_, descriptor);
}

std::vector<RankEvent> RankLinks::wait(std::chrono::milliseconds limit) {
  std::array<epoll_event, 64> ready{};
  const int count =
      ::epoll_wait(events_, ready.data(), static_cast<int>(ready.size()), static_cast<int>(limit.count()));
  std::vector<RankEvent> events;
  for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(count, 0)); ++i) {
    const int descriptor = ready[i].data.fd;
    if (descriptor == socket_)
      accept();
    else if (links_.contains(descriptor))
      read(descriptor, events);
  }
  return events;
}

void RankLinks::accept() {
  const int connection = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (connection < 0) return;
  ucred peer{};
  socklen_t bytes = sizeof(peer);
  if (::getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &peer, &bytes) != 0 || peer.uid != ::geteuid()) {
    ::close(connection);
    return;
  }
  links_[connection].process = peer.pid;
  watch(events_, connection);
}

void RankLinks::read(int connection, std::vector<RankEvent>& events) {
  Link& link = links_.at(connection);
  for (;;) {
    ranks::StarterWord word{};
    const ssize_t bytes = ::recv(connection, &word, sizeof(word), 0);
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0 && errno == EAGAIN) return;
    if (bytes != static_cast<ssize_t>(sizeof(word))) break;
    link.rank = word.rank;
    link.keeper = link.keeper || word.kind == ranks::StarterWord::Kind::keeps;
    if (word.kind != ranks::StarterWord::Kind::keeps)
      events.push_back({kind_of(word.kind), word.rank, link.process, word.status});
  }
  if (link.keeper) events.push_back({RankEvent::Kind::keeper_gone, *link.rank, link.process, 0});
  ::close(connection);
  links_.erase(connection);
}

std::optional<pid_t> RankLinks::process_of(unsigned rank) const {
  for (const auto& [connection, link] : links_) {
    if (link.rank == rank && !link.keeper && link.process > 0) return link.process;
  }
  return std::nullopt;
}

std::vector<pid_t> RankLinks::processes() const {
  std::vector<pid_t> all;
  for (const auto& [connection, link] : links_) {
    if (link.process > 0) all.push_back(link.process);
  }
  return all;
}

}  // namespace torolux::launch
