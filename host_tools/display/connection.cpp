// SPDX-License-Identifier: MIT
// poll, recv and send.
#include "host_tools/display/connection.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

namespace torolux {
namespace {

constexpr std::size_t kMostRequestBytes = std::size_t{96} << 10U;  // headers and body
constexpr std::chrono::seconds kRequestPatience{5};
constexpr std::chrono::seconds kWritePatience{10};  // without a single byte taken
constexpr std::chrono::milliseconds kLook{100};     // at `stopping`

}  // namespace

Connection::Connection(socket_t socket, const std::atomic<bool>& stopping)
    : socket_(socket),
      stopping_(stopping),
      end_of_request_(Clock::now() + kRequestPatience),
      bytes_left_(kMostRequestBytes) {}

bool Connection::wait_until(short event, Clock::time_point end) const {
  while (true) {
    // What is being written when all ends may still go, if it goes at once.
    if (stopping_) {
      pollfd wanted{socket_, event, 0};
      return event == POLLOUT && ::poll(&wanted, 1, static_cast<int>(kLook.count())) > 0;
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0) return false;
    pollfd wanted{socket_, event, 0};
    const int ready = ::poll(&wanted, 1, static_cast<int>(std::min(left, kLook).count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

bool Connection::is_readable() const {
  return begin_ < end_ || wait_until(POLLIN, end_of_request_);
}

bool Connection::is_writable() const {
  return wait_until(POLLOUT, Clock::now() + kWritePatience);
}

ssize_t Connection::read(char* to, std::size_t size) {
  if (begin_ == end_) {
    if (bytes_left_ == 0 || !wait_until(POLLIN, end_of_request_)) return -1;
    const ssize_t got = ::recv(socket_, buffer_.data(), std::min(buffer_.size(), bytes_left_), 0);
    if (got <= 0) return got;
    begin_ = 0;
    end_ = static_cast<std::size_t>(got);
    bytes_left_ -= end_;
  }
  const std::size_t count = std::min(size, end_ - begin_);
  std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_), count, to);
  begin_ += count;
  return static_cast<ssize_t>(count);
}

ssize_t Connection::write(const char* from, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    if (!is_writable()) return -1;
    const ssize_t sent = ::send(socket_, from + done, size - done, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno != EAGAIN && errno != EINTR) return -1;
    if (sent > 0) done += static_cast<std::size_t>(sent);
  }
  return static_cast<ssize_t>(size);
}

/// Of no interest to anybody here.
void Connection::get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const {}
void Connection::get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const {}

}  // namespace torolux
