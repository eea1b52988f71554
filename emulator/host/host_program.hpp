// SPDX-License-Identifier: MIT
// The host as the machine sees it: a program that reacts to messages in virtual time. Host tools write programs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "emulator/description/host_work.hpp"
#include "emulator/torus/record_kinds.hpp"
#include "firmware/protocol/machine.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

class SnapshotWriter;  // emulator/snapshot/archive.hpp

using protocol::PeNumber;
using Cycles = std::uint64_t;  ///< virtual time
using PixelSums = std::array<std::int64_t, 3>;

/// Sums of a plane that the host reads from the frame buffer.
struct FrameRead {
  protocol::Plane plane;
  std::uint32_t first;  ///< pixel: row * width + column
  std::uint32_t count;  ///< 1..kMostPixelsRead
};
/// One message has them.
inline constexpr std::uint32_t kMostPixelsRead = (protocol::kMostMessageBytes - sizeof(FrameRead)) / sizeof(PixelSums);

/// What only a host program knows of the run.
enum class HostGauge : std::uint8_t {
  records_in_flight,  ///< credits that are not at home
  unshot,             ///< of the emitted flux, as of the last selection
  count
};
inline constexpr std::size_t kHostGauges = static_cast<std::size_t>(HostGauge::count);
inline constexpr std::array<std::string_view, kHostGauges> kHostGaugeNames = {"records_in_flight", "unshot"};

/// What a host program may do. Sends never block: they queue in host memory, in order for each PE, and the bus takes
/// them as the PE has room (a control buffer, or reserved record slots). A message sent or taken in costs the host's
/// clock by itself (HostWork::message and copy); all else that a program computes it must say.
class HostPort {
 public:
  virtual ~HostPort() = default;
  virtual Cycles now() const = 0;
  virtual unsigned pes() const = 0;
  /// From now on all counts are this stage's; the first call names the one that has begun with the run. Where nothing
  /// is in flight. Throws MachineFailure beyond kMostStages.
  virtual void begin_stage(std::string_view name) = 0;
  /// From now on the gauge has this value. For the time line; costs nothing.
  virtual void note(HostGauge gauge, double value) = 0;
  /// Moves the host's clock: so many items of this have been done.
  virtual void work(HostWork what, std::uint64_t items) = 0;
  /// kind: MessageKind. contents: up to kMostMessageBytes, copied.
  virtual void send_message(PeNumber pe, std::uint16_t kind, std::span<const std::byte> contents) = 0;
  /// The same to every PE, as one message that all hear at once: it waits for all sends made earlier, to whatever PE,
  /// and for a free control buffer at each; what is made later waits for it.
  virtual void broadcast(std::uint16_t kind, std::span<const std::byte> contents) = 0;
  /// records: count * record_bytes, count 1..kMostRecordsPerPacket. The NIU puts them into its slots.
  virtual void send_records(PeNumber pe, std::span<const std::byte> records, std::uint32_t record_bytes) = 0;
  /// Asks the frame buffer controller for sums: HostProgram::on_pixels brings them, in the order of the calls. It waits
  /// for all sends made earlier, and what is made later waits for it. The controller answers when it has added what had
  /// come to it before.
  virtual void read_pixels(const FrameRead& read) = 0;
  /// Messages and record packets not yet taken by the bus, to this PE, broadcasts included.
  virtual std::size_t queued(PeNumber pe) const = 0;
};

class HostProgram : public RecordKinds {
 public:
  virtual void start(HostPort& port) = 0;
  /// Called in order of virtual time. Diverted records do not come here: the machine sends them again by itself.
  virtual void on_message(HostPort& port, PeNumber source, std::uint16_t kind, std::span<const std::byte> contents) = 0;
  /// What read_pixels asked for. Called in order of virtual time, like on_message.
  virtual void on_pixels(HostPort& /*port*/, const FrameRead& /*read*/, std::span<const PixelSums> /*sums*/) {}
  /// Names of the kinds of records that the PEs send each other; the machine knows none of itself.
  virtual std::span<const std::string_view> record_kinds() const { return {}; }
  /// The run ends when this is true, nothing is in flight and the FBC has drained.
  virtual bool finished() const = 0;
  /// For the deadlock report: what the program waits for.
  virtual const char* waiting_for() const = 0;

  /// Whether `save` gives all that a run changes of it: then a debugger may go back to states in between.
  virtual bool can_be_saved() const { return false; }
  /// Between two messages.
  virtual void save(SnapshotWriter& /*archive*/) {}
};

/// The picture as the frame buffer controller adds it up; row 0 on top.
struct FrameBuffer {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::array<std::vector<PixelSums>, protocol::kPlanes> planes;  ///< by protocol::Plane; empty: not there

  const std::vector<PixelSums>& plane(protocol::Plane plane) const { return planes[static_cast<std::size_t>(plane)]; }
};

}  // namespace torolux
