// SPDX-License-Identifier: MIT
// Payloads that PEs of one rank send those of another: gathered, one message for each rank; and out of these messages
// again, each of which must be the next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "emulator/errors.hpp"
#include "emulator/remote/wire.hpp"

namespace torolux::remote {

class PayloadOutbox {
 public:
  /// machine: as in BlockSetup; rank_of: of each PE.
  PayloadOutbox(std::uint32_t machine, const std::vector<unsigned>& rank_of) : machine_(machine), rank_of_(rank_of) {}

  void put(const PacketName& name, std::span<const std::byte> payload) {
    ByteWriter& bytes = lanes_[rank_of_.at(name.destination)].bytes;
    if (bytes.empty()) bytes.put(PayloadsBegin{});
    bytes.put(name);
    bytes.put_bytes(payload);
    bytes_ += sizeof name + payload.size();
  }
  /// Waiting to be sent.
  std::size_t bytes() const { return bytes_; }
  /// send: is given each rank that there is something for, and a message's bytes.
  template <class Send>
  void send_all(Send send) {
    for (auto& [rank, lane] : lanes_) {
      if (lane.bytes.empty()) continue;
      lane.bytes.replace(0, PayloadsBegin{machine_, lane.sent++});
      send(rank, lane.bytes.bytes());
      lane.bytes.clear();
    }
    bytes_ = 0;
  }

 private:
  struct Lane {
    ByteWriter bytes;
    std::uint32_t sent = 0;  // messages
  };
  std::uint32_t machine_;
  std::vector<unsigned> rank_of_;
  std::map<unsigned, Lane> lanes_;  // by rank
  std::size_t bytes_ = 0;
};

class PayloadInbox {
 public:
  /// As PayloadOutbox; own: this rank.
  PayloadInbox(std::uint32_t machine, const std::vector<unsigned>& rank_of, unsigned own)
      : machine_(machine), rank_of_(rank_of), own_(own) {}

  /// take: is given each PacketName and its payload. A message for a machine before this one is nobody's any more.
  /// Throws MachineFailure, and names the rank, where the message is not the next, or not one of these.
  template <class Take>
  void read(unsigned from, std::span<const std::byte> bytes, Take take) {
    ByteReader reader(bytes);
    if (reader.left() < sizeof(PayloadsBegin)) refuse(from, "are damaged");
    const auto begin = reader.get<PayloadsBegin>();
    if (begin.machine < machine_) return;
    if (begin.machine > machine_ || begin.number != read_[from]++)
      refuse(from, "are not the next: some have been lost");
    while (!reader.empty()) {
      if (reader.left() < sizeof(PacketName)) refuse(from, "are damaged");
      const auto name = reader.get<PacketName>();
      if (!is_on(from, name.source) || !is_on(own_, name.destination) || name.bytes > reader.left())
        refuse(from, "are damaged");
      take(name, reader.get_bytes(name.bytes));
    }
  }

 private:
  bool is_on(unsigned rank, unsigned pe) const { return pe < rank_of_.size() && rank_of_[pe] == rank; }
  [[noreturn]] static void refuse(unsigned from, const std::string& what) {
    throw MachineFailure("payloads of packets that have come from rank " + std::to_string(from) + " " + what);
  }

  std::uint32_t machine_;
  std::vector<unsigned> rank_of_;
  unsigned own_;
  std::map<unsigned, std::uint32_t> read_;  // messages, by rank
};

}  // namespace torolux::remote
