// SPDX-License-Identifier: MIT
// HTTP as bytes over a socket to this computer: what a test wants to send enters, what came back leaves.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace torolux::testing_support {

class RawHttp {
 public:
  /// To 127.0.0.1. receive_buffer: of the socket, in bytes; 0: as usual.
  explicit RawHttp(int port, int receive_buffer = 0);
  RawHttp(RawHttp&& other) noexcept;
  RawHttp(const RawHttp&) = delete;
  RawHttp& operator=(const RawHttp&) = delete;
  RawHttp& operator=(RawHttp&&) = delete;
  ~RawHttp() { close(); }

  bool connected() const { return socket_ >= 0; }
  /// False: the other end takes no more.
  bool send(const std::string& bytes) const;
  /// Until the other end closes, or so many bytes have come, or for so long nothing more has.
  std::string receive(std::chrono::milliseconds patience = std::chrono::seconds(10),
                      std::size_t most = std::size_t{1} << 30U) const;
  void close();

 private:
  int socket_ = -1;
};

/// Sends this and returns all that comes.
std::string response_to(int port, const std::string& request);
/// "GET path" with a Host that is right, and further headers (each ended by "\r\n").
std::string get_request(int port, const std::string& path, const std::string& headers = "");
/// A command as a page sends it.
std::string command_request(int port, const std::string& body, const std::string& headers = "");
/// Of a response; 0: there was none.
int status_of(const std::string& response);
/// Of an URL "http://host:port/...".
int port_of(const std::string& url);
/// The contents of a chunked answer, as far as they have come.
std::string unchunked(const std::string& response);

}  // namespace torolux::testing_support
