// SPDX-License-Identifier: MIT
// The line to one debugger: packets in and out of a socket; nobody is waited for longer than is said.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "emulator/debugger/packets.hpp"
#include "emulator/engines/engine/gdb_socket.hpp"

namespace torolux::debugger {

class Connection {
 public:
  /// Listens. Throws InputError where that cannot be.
  explicit Connection(const GdbEndpoint& place) : socket_(place) {}
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection();

  const GdbEndpoint& place() const { return socket_.endpoint(); }  ///< with the port that it has got
  /// There was a debugger, and it is gone.
  bool has_ended() const { return ended_; }
  /// The next packet, or Ctrl-C: waits so long for a debugger, or for what it says.
  std::optional<PacketReader::Item> next(std::chrono::milliseconds longest);
  void send(const std::string& contents);
  /// Once the next packet has been sent, no more "+".
  void leave_out_acknowledgements() { acknowledged_ = false; }
  void close();

 private:
  bool await(int descriptor, std::chrono::milliseconds longest);
  void receive();
  void send_bytes(const std::string& bytes);

  GdbSocket socket_;
  int line_ = -1;
  bool ended_ = false;
  bool acknowledged_ = true;
  PacketReader reader_;
  std::string last_;  // packet sent, in its frame
};

}  // namespace torolux::debugger
