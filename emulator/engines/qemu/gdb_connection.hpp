// SPDX-License-Identifier: MIT
// Our own line to a QEMU's debugger stub, by which a PE is stopped, and its registers are read and set: commands of
// GDB's remote serial protocol in, replies out.
#pragma once

#include <cstdint>
#include <string>

namespace torolux {

class GdbConnection {
 public:
  /// A pair of sockets: one end is QEMU's. Throws MachineFailure, as all of this does where QEMU is gone or silent.
  GdbConnection();
  GdbConnection(GdbConnection&& other) noexcept;
  GdbConnection& operator=(GdbConnection&&) = delete;
  ~GdbConnection();

  /// To be inherited, then left.
  int qemus_end() const { return qemus_; }
  void leave_to_qemu();

  std::string ask(const std::string& command);
  /// Without waiting for a reply: the processor runs until `interrupt`.
  void let_run() { send("c"); }
  /// Stops it between two blocks.
  void interrupt();
  /// Executes one instruction.
  void step() { ask("s"); }
  std::uint32_t read(unsigned number);
  void write(unsigned number, std::uint32_t value);

 private:
  void send(const std::string& command);
  void send_bytes(const std::string& bytes) const;
  std::string reply();
  char next();

  int ours_ = -1, qemus_ = -1;
  std::string received_;  // not yet looked at
};

}  // namespace torolux
