// SPDX-License-Identifier: MIT
// A socket that listens for a debugger: opened here, so that a port in use is known before anything runs; QEMU gets it.
#pragma once

#include <cstdint>
#include <filesystem>

#include "emulator/engines/engine/debugging.hpp"

namespace torolux {

class GdbSocket {
 public:
  /// Listens on 127.0.0.1, or where the endpoint has a path on a Unix socket of mode 0600 that is made there. Throws
  /// InputError where that cannot be.
  explicit GdbSocket(const GdbEndpoint& endpoint);
  GdbSocket(GdbSocket&& other) noexcept;
  GdbSocket(const GdbSocket&) = delete;
  GdbSocket& operator=(const GdbSocket&) = delete;
  GdbSocket& operator=(GdbSocket&&) = delete;
  /// A Unix socket goes from its folder.
  ~GdbSocket();

  int descriptor() const { return descriptor_; }             ///< close-on-exec; -1 once it has been left to QEMU
  const GdbEndpoint& endpoint() const { return endpoint_; }  ///< with the port that it has got
  /// From now on QEMU alone listens: nobody connects to a PE that is gone.
  void leave_to_qemu();

 private:
  void listen_on_port();
  void listen_on_path();

  GdbEndpoint endpoint_;
  int descriptor_ = -1;
  bool file_is_ours_ = false;
};

}  // namespace torolux
