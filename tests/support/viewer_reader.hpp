// SPDX-License-Identifier: MIT
// A viewer, written from the protocol (tev's IPC) alone: it listens, a renderer's messages enter, pictures leave.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace torolux::testing_support {

struct ViewedPicture {
  std::int32_t width = 0, height = 0;
  std::map<std::string, std::vector<float>> channels;  ///< zeros at first
  int created = 0, updates = 0;                        ///< messages
};

class ViewerReader {
 public:
  enum class Manner { reads, never_reads };

  /// port: of 127.0.0.1; 0: any free one.
  explicit ViewerReader(std::uint16_t port = 0, Manner manner = Manner::reads);
  ViewerReader(const ViewerReader&) = delete;
  ViewerReader& operator=(const ViewerReader&) = delete;
  /// Goes: closes what is open.
  ~ViewerReader();

  std::uint16_t port() const { return port_; }
  /// "127.0.0.1:PORT"
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  /// What has come so far; by name.
  std::map<std::string, ViewedPicture> pictures() const;
  /// What was against the protocol; empty: nothing.
  std::string fault() const;
  int connections() const { return connections_; }
  /// Waits until the last connection has been closed from the other side.
  void wait_for_end() const;

 private:
  void work();
  void read(int connection);
  void take(std::span<const std::uint8_t> message);

  std::uint16_t port_ = 0;
  Manner manner_;
  int listener_ = -1;
  std::atomic<int> connections_ = 0, ended_ = 0;
  std::atomic<bool> over_ = false;
  mutable std::mutex mutex_;
  std::map<std::string, ViewedPicture> pictures_;
  std::string fault_;
  std::thread thread_;
};

}  // namespace torolux::testing_support
