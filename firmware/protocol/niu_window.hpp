// SPDX-License-Identifier: MIT
// The NIU window: the page of local memory through which processor and NIU pass arguments and results of a HINT.
// An image places one at the symbol `__niu_window`, aligned to kPageBytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/protocol/machine.hpp"

namespace torolux::protocol {

enum class ArrivalKind : std::uint32_t { none = 0, records = 1, message = 2 };  ///< what has come

/// Head of every bus message.
struct MessageHeader {
  std::uint16_t kind;   ///< MessageKind of the program in charge; below kFirstProgramMessage: of the machine.
  PeNumber source;      ///< set by the NIU
  std::uint32_t bytes;  ///< of what follows, 0..kMostMessageBytes
};
static_assert(sizeof(MessageHeader) == 8);

/// Why a PE failed (Hint::fail).
struct Fault {
  std::uint32_t code;       ///< FaultCode of the program, or of the machine (traps)
  std::uint32_t detail[3];  ///< depends on the code
};
static_assert(sizeof(Fault) == 16);

struct NiuWindow {  ///< at the symbol `__niu_window`; whoever is not named as setting a field only reads it
  // Set by the emulator before the start.
  std::uint32_t protocol_version;
  std::uint32_t pe;             ///< own number
  std::uint32_t columns, rows;  ///< of the torus
  std::uint32_t local_memory_bytes;

  // Set by the NIU.
  std::uint32_t retry;  ///< not 0: the HINT has not happened yet, execute it again (costs no cycles)
  std::uint64_t clock;  ///< [cycles], by Hint::clock

  struct Arrival {
    ArrivalKind kind;
    std::uint16_t source;                                    ///< PE or kHost
    std::uint16_t count;                                     ///< records
    std::array<std::uint16_t, kMostRecordsPerPacket> slots;  ///< where the NIU put them; now the program's
  } arrival;

  struct Slots {
    std::uint32_t address;  ///< of slot 0
    std::uint32_t bytes;    ///< of one slot (= of one record), a multiple of 8, at most kMostPacketBytes
    std::uint32_t own;      ///< slots 0 .. own-1 are the program's, for records that it creates
    std::uint32_t niu;      ///< slots own .. own+niu-1 are the NIU's, for records that arrive
  } slots;

  struct Send {
    std::uint16_t destination;  ///< PE for send_records; kHost or kFrameBuffer for send_message
    std::uint16_t count;        ///< records, 1..kMostRecordsPerPacket (send_records)
    std::uint32_t address;      ///< of the MessageHeader (send_message)
    std::array<std::uint16_t, kMostRecordsPerPacket> slots;
  } send;

  /// How long the NIU lets records gather before it wakes the processor from `receive` (interrupt moderation): until so
  /// many cycles after the first of them came, or until there are so many. Set by the program; zeros at the start: it
  /// wakes at once.
  struct Gather {
    std::uint32_t cycles;
    std::uint32_t records;
  } gather;

  /// NIU slots whose records have died: freed, and `released` set to 0, by the next send or receive.
  std::uint32_t released;
  std::array<std::uint16_t, 64> release;

  Fault fault;

  /// The last message that came. Overwritten by the next receive that brings a message.
  alignas(8) MessageHeader message;
  std::array<std::byte, kMostMessageBytes> message_bytes;
};
static_assert(offsetof(NiuWindow, message_bytes) == offsetof(NiuWindow, message) + sizeof(MessageHeader));
static_assert(sizeof(NiuWindow) <= kPageBytes);
static_assert(offsetof(NiuWindow, retry) == 20, "the NIU driver's loop reads it");

/// Messages below this number mean the same for every image; see messages.hpp for Torolux's own.
inline constexpr std::uint16_t kFirstProgramMessage = 16;
enum class MachineMessage : std::uint16_t {
  text = 1,      ///< PE -> host: UTF-8 without end mark; `torolux run` prints it with the PE's number and clock
  diverted = 2,  ///< NIU -> host memory: records for which no slot was free (made by the NIU, never by a program)
  pixels = 3,    ///< PE -> FBC: PixelAdd[]
  // Of programs with the kit (host_services.hpp).
  output = 4,        ///< PE -> host: Output, then bytes for a stream
  exit_status = 5,   ///< PE -> host: ExitStatus
  to_host = 6,       ///< PE -> host: bytes for the file that the user has named for that
  file_open = 7,     ///< PE -> host: FileOpen; answer: file_answer
  file_read = 8,     ///< PE -> host: FileRead; answer: file_data
  file_write = 9,    ///< PE -> host: FileWrite, then bytes
  file_seek = 10,    ///< PE -> host: FileSeek; answer: file_answer
  file_close = 11,   ///< PE -> host: FileClose
  file_answer = 12,  ///< host -> PE: FileAnswer
  file_data = 13,    ///< host -> PE: FileData, then bytes
};

/// The frame buffer has a plane of three sums per pixel for the colours, and others on request: the layers of a
/// picture. All but the first tell of the first surface that a camera ray meets. Q: quantum of the ray tracing stage's
/// radiance.
enum class Plane : std::uint32_t {
  colour,      ///< R, G, B [Q]
  irradiance,  ///< on the side that is seen, over pi: R, G, B [Q]
  depth,       ///< distance from the eye [kLayerUnit of the object space's longest edge]; samples that met something; 0
  normals,     ///< of the side that is seen: x, y, z [kLayerUnit]
  elements,    ///< sample 0 only: polygon's global number + 1; path of the element in it, or -1: none there; side
  owner,       ///< sample 0 only: number of the PE that found the surface, + 1; 0; 0
  cost,        ///< subspaces visited by all rays of the pixel; 0; 0
};
inline constexpr std::uint32_t kPlanes = 7;
inline constexpr float kLayerUnit = 0x1p-24F;
/// Bit of a plane in a set of them.
constexpr std::uint32_t plane_bit(Plane plane) {
  return 1U << static_cast<std::uint32_t>(plane);
}

/// One addition to the frame buffer.
struct PixelAdd {
  std::int64_t value[3];
  std::uint32_t pixel;  ///< row * width + column, row 0 on top
  Plane plane;
};
static_assert(sizeof(PixelAdd) == 32);
inline constexpr std::uint32_t kMostPixelsPerMessage = kMostMessageBytes / sizeof(PixelAdd);

}  // namespace torolux::protocol
