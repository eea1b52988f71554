// SPDX-License-Identifier: MIT
// A port without a machine behind it: what a phase sends enters, and stands in a list for the test to look at.
#pragma once

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "host_tools/stages/phase.hpp"

namespace torolux::test {

struct Sent {
  PeNumber pe = 0;
  std::uint16_t kind = 0;          ///< of a message
  std::uint32_t record_bytes = 0;  ///< not 0: a packet of records
  std::vector<std::byte> bytes;

  bool is(protocol::MessageKind wanted) const {
    return record_bytes == 0 && kind == static_cast<std::uint16_t>(wanted);
  }
  template <typename T>
  T as(std::size_t index = 0) const {
    T value{};
    if (bytes.size() >= (index + 1) * sizeof(T)) std::memcpy(&value, bytes.data() + index * sizeof(T), sizeof(T));
    return value;
  }
};

class FakePort final : public HostPort {
 public:
  explicit FakePort(unsigned pes) : pes_(pes) {}

  Cycles now() const override { return 0; }
  unsigned pes() const override { return pes_; }
  void begin_stage(std::string_view /*name*/) override {}
  void note(HostGauge /*gauge*/, double /*value*/) override {}
  void work(HostWork what, std::uint64_t items) override { done_[static_cast<std::size_t>(what)] += items; }
  /// Items of work so far.
  std::uint64_t done(HostWork what) const { return done_[static_cast<std::size_t>(what)]; }
  void send_message(PeNumber pe, std::uint16_t kind, std::span<const std::byte> contents) override {
    waiting_.push_back({pe, kind, 0, {contents.begin(), contents.end()}});
  }
  /// Stands in the list with PE kHost.
  void broadcast(std::uint16_t kind, std::span<const std::byte> contents) override {
    waiting_.push_back({protocol::kHost, kind, 0, {contents.begin(), contents.end()}});
  }
  void send_records(PeNumber pe, std::span<const std::byte> records, std::uint32_t record_bytes) override {
    waiting_.push_back({pe, 0, record_bytes, {records.begin(), records.end()}});
  }
  void read_pixels(const FrameRead& read) override { reads_.push_back(read); }
  std::size_t queued(PeNumber pe) const override {
    return static_cast<std::size_t>(std::count_if(waiting_.begin(), waiting_.end(), [pe](const Sent& sent) {
      return sent.pe == pe || sent.pe == protocol::kHost;
    }));
  }

  /// All that was sent since the last call; the queues are empty then.
  std::vector<Sent> take() { return std::exchange(waiting_, {}); }
  /// Likewise of reads.
  std::vector<FrameRead> take_reads() { return std::exchange(reads_, {}); }

 private:
  unsigned pes_;
  std::vector<Sent> waiting_;
  std::vector<FrameRead> reads_;
  std::array<std::uint64_t, kHostWorks> done_{};
};

/// A message from a PE.
template <typename T>
void tell(Phase& phase, HostPort& port, PeNumber source, protocol::MessageKind kind, const T& contents) {
  phase.on_message(port, source, kind, std::as_bytes(std::span(&contents, 1)));
}
inline void tell(Phase& phase, HostPort& port, PeNumber source, protocol::MessageKind kind) {
  phase.on_message(port, source, kind, {});
}

}  // namespace torolux::test
