// SPDX-License-Identifier: MIT
// A connection to a page, as cpp-httplib wants it: a socket enters; reads and writes of bounded length and time leave.
#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <string>

namespace torolux {

/// cpp-httplib reads lines and headers as long as they come. Here a request ends after so many bytes and seconds.
class Connection final : public httplib::Stream {
 public:
  /// stopping: ends all waiting. Both outlive this; the socket is closed by whoever has opened it.
  Connection(socket_t socket, const std::atomic<bool>& stopping);

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* to, std::size_t size) override;
  /// All of it, or an error (-1): nothing has gone for a while, or the other end is gone.
  ssize_t write(const char* from, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool wait_until(short event, Clock::time_point end) const;

  socket_t socket_;
  const std::atomic<bool>& stopping_;
  Clock::time_point end_of_request_;
  std::size_t bytes_left_;
  std::array<char, 4096> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // of what is in the buffer
};

}  // namespace torolux
