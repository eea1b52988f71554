// SPDX-License-Identifier: MIT
// A connection for the life of the process: where that ends, however it does, the system closes it.
#include "emulator/ranks/starter.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "emulator/ranks/launched.hpp"

namespace torolux::ranks {
namespace {

/// -1: nobody has started this rank so, or not on this computer.
int connected_socket() {
  const char* const name = std::getenv(kStarterVariable);
  if (name == nullptr || launched_ranks().count == 1) return -1;
  const std::string_view text = name;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (text.size() >= sizeof(address.sun_path)) return -1;
  std::memcpy(&address.sun_path[1], text.data(), text.size());  // the first byte is 0: abstract
  const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
  if (socket < 0 || ::connect(socket, reinterpret_cast<const sockaddr*>(&address), bytes) == 0) return socket;
  ::close(socket);
  return -1;
}

class Starter {
 public:
  Starter() : socket_(connected_socket()) { say(StarterWord::Kind::begins, 0); }
  Starter(const Starter&) = delete;
  Starter& operator=(const Starter&) = delete;
  ~Starter() {
    if (socket_ >= 0) ::close(socket_);
  }

  bool listens() const { return socket_ >= 0; }
  void say(StarterWord::Kind kind, int exit_code) const {
    if (socket_ < 0) return;
    const StarterWord word{kind, launched_ranks().own, exit_code};
    ::send(socket_, &word, sizeof(word), MSG_NOSIGNAL);
  }

 private:
  int socket_;
};

const Starter& starter() {
  static const Starter one;
  return one;
}

}  // namespace

bool greet_starter() {
  return starter().listens();
}

void tell_starter(int exit_code) {
  starter().say(StarterWord::Kind::ends, exit_code);
}

}  // namespace torolux::ranks
