// SPDX-License-Identifier: MIT
// socket, bind, listen.
#include "emulator/engines/engine/gdb_socket.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

/// Closes the descriptor, and tells of errno as it was.
[[noreturn]] void refuse(int descriptor, const std::string& where, const std::string& what_to_do) {
  const std::string reason = std::strerror(errno);
  if (descriptor >= 0) close(descriptor);
  throw InputError("no debugger can be awaited on " + where + ": " + reason + "; " + what_to_do);
}

}  // namespace

GdbSocket::GdbSocket(const GdbEndpoint& endpoint) : endpoint_(endpoint) {
  if (endpoint_.path.empty()) {
    listen_on_port();
  } else {
    listen_on_path();
  }
}

void GdbSocket::listen_on_port() {
  descriptor_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;  // a port that a debugger has just left may be taken again
  setsockopt(descriptor_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(endpoint_.port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t bytes = sizeof address;
  auto* plain = reinterpret_cast<sockaddr*>(&address);
  if (bind(descriptor_, plain, bytes) != 0 || listen(descriptor_, 1) != 0 ||
      getsockname(descriptor_, plain, &bytes) != 0) {
    refuse(descriptor_, "port " + std::to_string(endpoint_.port) + " of 127.0.0.1",
           "take another port, or 0 for any that is free");
  }
  endpoint_.port = ntohs(address.sin_port);
}

void GdbSocket::listen_on_path() {
  const std::string path = endpoint_.path.string();
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    refuse(-1, path, "at most " + std::to_string(sizeof address.sun_path - 1) + " characters are allowed");
  }
  std::ranges::copy(path, std::begin(address.sun_path));
  descriptor_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  // The file gets the mode that the socket has when it is bound: there is no moment in which others could connect.
  if (fchmod(descriptor_, S_IRUSR | S_IWUSR) != 0 ||
      bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    refuse(descriptor_, path, "take the path of a file that is not there yet, in a folder that you may write to");
  }
  file_is_ours_ = true;
  if (listen(descriptor_, 1) != 0) {
    const int reason = errno;
    unlink(path.c_str());
    errno = reason;
    refuse(descriptor_, path, "take a port instead");
  }
}

GdbSocket::GdbSocket(GdbSocket&& other) noexcept
    : endpoint_(std::move(other.endpoint_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      file_is_ours_(std::exchange(other.file_is_ours_, false)) {}

void GdbSocket::leave_to_qemu() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

GdbSocket::~GdbSocket() {
  leave_to_qemu();
  if (file_is_ours_) unlink(endpoint_.path.c_str());
}

}  // namespace torolux
