// SPDX-License-Identifier: MIT
// Accepts, reads, puts tiles into their places.
#include "tests/support/viewer_reader.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <stdexcept>

namespace torolux::testing_support {
namespace {

/// Values of a message, one after the other.
class Fields {
 public:
  explicit Fields(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint8_t byte() { return take(1)[0]; }
  std::int32_t number() {
    const auto bytes = take(4);
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8U | bytes[i];
    return static_cast<std::int32_t>(value);
  }
  std::string text() {
    std::string out;
    for (char c = static_cast<char>(byte()); c != 0; c = static_cast<char>(byte())) out += c;
    return out;
  }
  float real() {
    const std::int32_t bits = number();
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  bool over() const { return bytes_.empty(); }

 private:
  std::span<const std::uint8_t> take(std::size_t count) {
    if (bytes_.size() < count) throw std::runtime_error("a message ends too soon");
    const auto front = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return front;
  }
  std::span<const std::uint8_t> bytes_;
};

}  // namespace

ViewerReader::ViewerReader(std::uint16_t port, Manner manner) : manner_(manner) {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1, small = 4096;
  ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (manner == Manner::never_reads) ::setsockopt(listener_, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener_, 4) != 0 ||
      ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("cannot listen");
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { work(); });
}

ViewerReader::~ViewerReader() {
  over_ = true;
  thread_.join();
  ::close(listener_);
}

std::map<std::string, ViewedPicture> ViewerReader::pictures() const {
  const std::lock_guard lock(mutex_);
  return pictures_;
}

std::string ViewerReader::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

void ViewerReader::wait_for_end() const {
  while (connections_ == 0 || ended_ < connections_) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

void ViewerReader::work() {
  while (!over_) {
    pollfd wait{listener_, POLLIN, 0};
    if (::poll(&wait, 1, 10) <= 0) continue;
    const int connection = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0) continue;
    ++connections_;
    try {
      read(connection);
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      fault_ = error.what();
    }
    ::close(connection);
    ++ended_;
  }
}

void ViewerReader::read(int connection) {
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 65536> part{};
  while (!over_) {
    if (manner_ == Manner::never_reads) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      continue;
    }
    pollfd wait{connection, POLLIN, 0};
    if (::poll(&wait, 1, 10) <= 0) continue;
    const ssize_t got = ::recv(connection, part.data(), part.size(), 0);
    if (got <= 0) break;
    bytes.insert(bytes.end(), part.begin(), part.begin() + got);
    std::size_t at = 0;
    while (bytes.size() - at >= 4) {
      const auto length = static_cast<std::uint32_t>(Fields(std::span(bytes).subspan(at)).number());
      if (length < 5 || length > 1U << 24U) throw std::runtime_error("a length that cannot be");
      if (bytes.size() - at < length) break;
      take(std::span(bytes).subspan(at + 4, length - 4));
      at += length;
    }
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
  }
  if (!over_ && !bytes.empty()) throw std::runtime_error("it ended within a message");
}

void ViewerReader::take(std::span<const std::uint8_t> message) {
  const std::lock_guard lock(mutex_);
  Fields fields(message);
  const std::uint8_t kind = fields.byte();
  fields.byte();  // focus
  ViewedPicture& picture = pictures_[fields.text()];
  if (kind == 4) {
    ++picture.created;
    picture.channels.clear();
    picture.width = fields.number();
    picture.height = fields.number();
    const std::int32_t channels = fields.number();
    const auto pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    for (std::int32_t i = 0; i < channels; ++i) picture.channels[fields.text()].assign(pixels, 0.0F);
  } else if (kind == 3) {
    ++picture.updates;
    std::vector<float>& channel = picture.channels.at(fields.text());
    const std::int32_t left = fields.number(), top = fields.number();
    const std::int32_t width = fields.number(), height = fields.number();
    for (std::int32_t y = top; y < top + height; ++y)
      for (std::int32_t x = left; x < left + width; ++x)
        channel.at(static_cast<std::size_t>(y * picture.width + x)) = fields.real();
  } else {
    throw std::runtime_error("a kind that is not sent");
  }
  if (!fields.over()) throw std::runtime_error("a message is too long");
}

}  // namespace torolux::testing_support
