// SPDX-License-Identifier: MIT
// A TCP connection to a viewer that may not be there: bytes enter, the network takes them or not.
#pragma once

#include <sys/socket.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace torolux {

struct ViewerAddress {
  std::string host;
  std::uint16_t port = 0;
};

/// HOST, HOST:PORT or [IPV6]:PORT. Throws UsageError.
ViewerAddress parse_viewer_address(const std::string& text);

class ViewerConnection {
 public:
  /// Looks the host up. Throws InputError where there is none of that name.
  explicit ViewerConnection(const ViewerAddress& address);
  ViewerConnection(const ViewerConnection&) = delete;
  ViewerConnection& operator=(const ViewerConnection&) = delete;
  ~ViewerConnection() { close(); }

  bool open() const { return socket_ >= 0; }
  /// Whether it is open now. give_up: asked some times a second.
  bool connect(const std::function<bool()>& give_up);
  /// False: the viewer has gone, or was given up, and the connection is closed. stalled: asked some times a second
  /// while it takes nothing; true: give it up.
  bool send(std::span<const std::byte> bytes, const std::function<bool()>& stalled);
  /// Closes it where the viewer has gone. What it says is passed over.
  void look();
  void close();

 private:
  sockaddr_storage address_{};
  socklen_t length_ = 0;
  int socket_ = -1;
};

}  // namespace torolux
