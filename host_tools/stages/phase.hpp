// SPDX-License-Identifier: MIT
// A part of the host's program: it sends, reacts to messages, and is done at some point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

#include "emulator/errors.hpp"
#include "emulator/host/host_program.hpp"
#include "emulator/snapshot/archive.hpp"
#include "firmware/protocol/messages.hpp"

namespace torolux {

class Phase {
 public:
  virtual ~Phase() = default;
  virtual void start(HostPort& port) = 0;
  /// Throws MachineFailure where the message is not one that this phase expects.
  virtual void on_message(HostPort& port, PeNumber source, protocol::MessageKind kind,
                          std::span<const std::byte> contents) = 0;
  /// Likewise of sums that it has not asked for.
  virtual void on_pixels(HostPort& /*port*/, const FrameRead& read, std::span<const PixelSums> /*sums*/) {
    throw MachineFailure("the frame buffer controller sent pixels from " + std::to_string(read.first) +
                         " on, which nobody had asked for");
  }
  virtual bool done() const = 0;
  virtual const char* waiting_for() const = 0;
  /// All that changes after it has been made: it goes on, instead of being started, from what another one has saved.
  virtual void save(SnapshotWriter& archive) = 0;
  virtual void restore(SnapshotReader& archive) = 0;
};

/// The contents of a message from a PE as the struct that they must be; `least` bytes of it must be there.
template <typename T>
T contents_as(PeNumber source, std::span<const std::byte> contents, std::size_t least = sizeof(T)) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (contents.size() < least) {
    throw MachineFailure("PE " + std::to_string(source) +
                         " sent a message that is too short: " + std::to_string(contents.size()) + " bytes; at least " +
                         std::to_string(least) + " are needed. Are the image and torolux of one version?");
  }
  T value{};
  std::memcpy(&value, contents.data(), contents.size() < sizeof(T) ? contents.size() : sizeof(T));
  return value;
}

template <typename T>
void send(HostPort& port, PeNumber pe, protocol::MessageKind kind, const T& contents) {
  port.send_message(pe, static_cast<std::uint16_t>(kind), std::as_bytes(std::span(&contents, 1)));
}
inline void send(HostPort& port, PeNumber pe, protocol::MessageKind kind) {
  port.send_message(pe, static_cast<std::uint16_t>(kind), {});
}

[[noreturn]] inline void unexpected(PeNumber source, protocol::MessageKind kind, const char* phase) {
  throw MachineFailure("PE " + std::to_string(source) + " sent message " + std::to_string(static_cast<unsigned>(kind)) +
                       ", not expected while " + phase);
}

}  // namespace torolux
