// SPDX-License-Identifier: MIT
// A socket that listens for a debugger: opened here, so that a port in use is known before anything runs; QEMU gets it.
#pragma once

#include <cstdint>

namespace torolux {

class GdbSocket {
 public:
  /// Listens on 127.0.0.1. port 0: any that is free. Throws InputError where it is in use or not allowed.
  explicit GdbSocket(std::uint16_t port);
  GdbSocket(GdbSocket&& other) noexcept;
  GdbSocket(const GdbSocket&) = delete;
  GdbSocket& operator=(const GdbSocket&) = delete;
  GdbSocket& operator=(GdbSocket&&) = delete;
  ~GdbSocket();

  int descriptor() const { return descriptor_; }  ///< close-on-exec
  std::uint16_t port() const { return port_; }    ///< that it has got

 private:
  int descriptor_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace torolux
