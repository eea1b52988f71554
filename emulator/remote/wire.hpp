// SPDX-License-Identifier: MIT
// What the rank with the network and the ranks with PEs tell each other; all run the same program. News of PEs go to
// the network, words for PEs come back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "emulator/engines/engine/registers.hpp"
#include "emulator/errors.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/torus/kind_rules.hpp"

namespace torolux::remote {

enum class Kind : std::uint32_t {
  greeting = 1,   ///< to rank 0: Greeting
  setup,          ///< from rank 0: BlockSetup
  ready,          ///< to rank 0: the PEs are there, and whether they can be saved, as a bool
  restore,        ///< from rank 0, before the start: of one PE, as RestoredPe writes it
  restored,       ///< to rank 0, empty: the PE is, and the next may come
  start,          ///< from rank 0: Start
  words,          ///< from rank 0: WordsBegin, then Words with what follows them
  news,           ///< to rank 0: News with what follows them
  payloads,       ///< from a rank with PEs to another: PayloadsBegin, then PacketNames, each with its payload behind it
  ask_figures,    ///< from rank 0, empty
  figures,        ///< to rank 0: PeCounts
  ask_memory,     ///< from rank 0: MemoryPart
  memory,         ///< to rank 0: what archive_memory writes
  ask_registers,  ///< from rank 0: a PE's number
  registers,      ///< to rank 0: std::optional<StackRegisters>
  hold,           ///< from rank 0, empty: no PE executes anything
  held,           ///< to rank 0, empty: that is so, and all news have been sent
  ask_kept,       ///< from rank 0, while held: PacketNames, of packets for PEs of that rank
  kept,           ///< to rank 0, once all that is under way has come: their payloads, which it keeps no longer
  ask_channel,    ///< from rank 0, while held: a PE's number
  channel,        ///< to rank 0: what NiuNetworkSide::save_channel writes
  ask_saved,      ///< from rank 0, while held: a PE's number
  saved,          ///< to rank 0: PeRegisters
  let_go,         ///< from rank 0, empty: they go on
  stop,           ///< from rank 0, empty: the machine is no more
  stopped,        ///< to rank 0, empty: that has been done
  failed,         ///< to rank 0: why this rank cannot go on, as a string
  close           ///< from rank 0: Close
};

struct Greeting {
  std::string host, program;  ///< program: which build of it

  template <class Archive>
  void archive(Archive& archive) {
    archive(host, program);
  }
};

struct Close {
  std::vector<unsigned> lost;  ///< ranks
  std::int32_t exit_code = 0;

  template <class Archive>
  void archive(Archive& archive) {
    archive(lost, exit_code);
  }
};

/// Of a packet from PE to PE whose payload does not go through rank 0.
struct PacketName {
  std::uint64_t number;  ///< of those that its source has sent, counted from 0
  std::uint16_t source, destination;
  std::uint32_t bytes;  ///< of the payload

  bool operator==(const PacketName&) const = default;
};

struct PayloadsBegin {
  std::uint32_t machine;  ///< as in BlockSetup
  std::uint32_t number;   ///< of these messages from that rank to this one, for that machine
};

struct Start {
  bool keeps_payloads = false;       ///< from PE to PE, where kinds are told; else all go through rank 0
  std::vector<KindRule> kind_rules;  ///< empty: nobody asks for kinds

  template <class Archive>
  void archive(Archive& archive) {
    archive(keeps_payloads, kind_rules);
  }
};

/// Whole pages.
struct MemoryPart {
  std::uint32_t pe, offset, bytes;
};

/// Of one PE: what its side of the channel says. Behind it `commands` entries, each a Command and its payload; one
/// whose payload goes another way has its length in `lent`. The commands come first, then all else, the bound next to
/// last, the wait last.
struct News {
  std::uint32_t pe;
  std::uint32_t commands;
  std::uint64_t bound, wait;
  std::uint64_t clock, copied, instructions, taken;
  std::uint32_t gather_cycles, gather_records;
  WaitCycles waits;
};

inline constexpr std::uint32_t kNoPe = 0xFFFF'FFFFU;

/// wanted: the PE without which nothing goes on; kNoPe: none.
struct WordsBegin {
  std::uint32_t wanted;
  std::uint32_t unused;
};

/// For one PE: what the network's side of its channel says. Behind it the times of departures, then the arrivals, each
/// an Arrival and its payload; or one with the payload's length in `lent`, and a PacketName. All counts but `arrivals`
/// are since the start.
struct Words {
  std::uint32_t pe;
  std::uint32_t arrivals;
  std::uint64_t torus_departures, bus_departures;
  std::uint64_t horizon, wake_time, wakes;
  std::uint64_t consumed;  ///< bytes of commands that the network has taken in
  std::uint64_t wake;      ///< 1: it is to look again
};

/// Of a PE that goes on from what was saved. Behind it what archive_channel_state and archive_memory write.
struct RestoredPe {
  std::uint32_t number = 0;
  PeRegisters registers{};

  template <class Archive>
  void archive(Archive& archive) {
    archive(number, registers);
  }
};

class ByteWriter {
 public:
  template <class Value>
  void put(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    put_bytes(std::as_bytes(std::span(&value, 1)));
  }
  void put_bytes(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  /// Over a value that was put at `at`.
  template <class Value>
  void replace(std::size_t at, const Value& value) {
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  std::size_t size() const { return bytes_.size(); }
  bool empty() const { return bytes_.empty(); }
  void clear() { bytes_.clear(); }
  void cut_to(std::size_t bytes) { bytes_.resize(bytes); }
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Throws MachineFailure where there are no more bytes.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <class Value>
  Value get() {
    Value value{};
    std::memcpy(&value, get_bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::span<const std::byte> get_bytes(std::size_t count) {
    if (bytes_.size() < count) throw MachineFailure("a message between ranks is too short");
    const auto bytes = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return bytes;
  }
  bool empty() const { return bytes_.empty(); }
  std::size_t left() const { return bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
};

/// Of commands that a PE's rank has sent and the network has not taken in yet [bytes of entries]. So many have room in
/// the mirror's ring wherever they come to lie: a gap at its end and two of the largest entries are left.
inline constexpr std::uint64_t kCommandWindow = kLeastRingBytes / 2;

/// Wherever its payload is.
constexpr std::size_t entry_bytes(const Command& command) {
  return sizeof command + (command.bytes + command.lent + 7U) / 8U * 8U;
}

}  // namespace torolux::remote
