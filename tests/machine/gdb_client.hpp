// SPDX-License-Identifier: MIT
// A debugger as far as tests need one: GDB's remote serial protocol over a socket. Commands in, replies out.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace torolux::test {

class GdbClient {
 public:
  /// Connects to 127.0.0.1. Throws std::runtime_error.
  explicit GdbClient(std::uint16_t port);
  /// Connects to a Unix socket. Throws std::runtime_error.
  explicit GdbClient(const std::filesystem::path& path);
  GdbClient(const GdbClient&) = delete;
  GdbClient& operator=(const GdbClient&) = delete;
  ~GdbClient();

  /// Sends a command and returns the reply; nothing where the connection has ended, or no reply comes for ten seconds.
  std::optional<std::string> ask(const std::string& command);
  /// The same in two halves, for commands that let the PE run.
  void send(const std::string& command);
  std::optional<std::string> reply();
  /// As Ctrl-C: stops the PE, which then gives a reply.
  void interrupt();

  /// x0 to x31 and the pc.
  std::array<std::uint32_t, 33> registers();
  std::uint32_t pc() { return registers()[32]; }

 private:
  void wait_at_most_ten_seconds() const;
  std::optional<char> next();

  int socket_ = -1;
};

}  // namespace torolux::test
