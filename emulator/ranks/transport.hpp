// SPDX-License-Identifier: MIT
// Messages of one rank enter, those for it leave: all that ranks know of each other goes through these six calls.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulator/errors.hpp"

namespace torolux::ranks {

/// A rank was lost, or one has ended all of them. The message names it.
class RankFailure : public MachineFailure {
 public:
  using MachineFailure::MachineFailure;
};

struct Ranks {
  unsigned own = 0, count = 1;  ///< own: 0..count - 1
};

struct Message {
  unsigned from = 0;
  std::uint32_t kind = 0;
  std::vector<std::byte> bytes;
};

/// What kinds mean is up to who sends them, but for this one (life_signs.hpp).
inline constexpr std::uint32_t kLifeSign = 0;
/// MPI promises tags up to this one.
inline constexpr std::uint32_t kMostKind = 32767;

/// One rank's end. Messages of one rank to another arrive whole, once and in the order in which they were sent,
/// whatever their kinds; nothing is said of the order between pairs. `send` may be called by any thread, the others by
/// one.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  virtual Ranks ranks() const = 0;
  /// Returns at once; `bytes` are copied. kind: up to kMostKind; to: also the own rank. What a lost rank is sent is
  /// lost, too.
  virtual void send(unsigned to, std::uint32_t kind, std::span<const std::byte> bytes) = 0;
  /// The next message, where one is there.
  virtual std::optional<Message> poll() = 0;
  /// Sleeps until `poll` has a message, `limit` at most. False: it has none.
  virtual bool wait(std::chrono::milliseconds limit) = 0;
  /// Ends all ranks with ExitCode::machine_failure, and says why, and which rank it was.
  [[noreturn]] virtual void abort(const std::string& reason) = 0;
  /// Nothing is sent or received afterwards. All ranks close, and each waits for the others; all that was sent has been
  /// handed over then. lost: those that cannot; then the others are not waited for either, and where ranks are
  /// processes all of them end here, with exit_code.
  virtual void close(std::span<const unsigned> lost, int exit_code) = 0;
};

}  // namespace torolux::ranks
