// SPDX-License-Identifier: MIT
// Plain sockets.
#include "tests/support/raw_http.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <utility>

namespace torolux::testing_support {

RawHttp::RawHttp(int port, int receive_buffer) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (receive_buffer > 0) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) close();
}

RawHttp::RawHttp(RawHttp&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}

void RawHttp::close() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

bool RawHttp::send(const std::string& bytes) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t sent = ::send(socket_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    done += static_cast<std::size_t>(sent);
  }
  return true;
}

std::string RawHttp::receive(std::chrono::milliseconds patience, std::size_t most) const {
  std::string all;
  std::array<char, 65536> buffer{};
  while (all.size() < most) {
    pollfd wanted{socket_, POLLIN, 0};
    if (::poll(&wanted, 1, static_cast<int>(patience.count())) <= 0) break;
    const ssize_t got = ::recv(socket_, buffer.data(), buffer.size(), 0);
    if (got <= 0) break;
    all.append(buffer.data(), static_cast<std::size_t>(got));
  }
  return all;
}

std::string response_to(int port, const std::string& request) {
  const RawHttp connection(port);
  connection.send(request);
  return connection.receive();
}

std::string get_request(int port, const std::string& path, const std::string& headers) {
  return "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n" + headers + "\r\n";
}

std::string command_request(int port, const std::string& body, const std::string& headers) {
  return "POST /command HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
         "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" + headers +
         "\r\n" + body;
}

int status_of(const std::string& response) {
  return response.starts_with("HTTP/1.1 ") ? std::stoi(response.substr(9)) : 0;
}

int port_of(const std::string& url) {
  return std::stoi(url.substr(url.find(':', std::string("http://").size()) + 1));
}

std::string unchunked(const std::string& response) {
  std::string contents;
  std::size_t at = response.find("\r\n\r\n");
  at = at == std::string::npos ? response.size() : at + 4;
  while (at < response.size()) {
    const std::size_t end = response.find("\r\n", at);
    if (end == std::string::npos) break;
    const std::size_t length = std::stoul(response.substr(at, end - at), nullptr, 16);
    if (end + 2 + length > response.size()) break;
    contents += response.substr(end + 2, length);
    at = end + 2 + length + 2;
  }
  return contents;
}

}  // namespace torolux::testing_support
