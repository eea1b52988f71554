// SPDX-License-Identifier: MIT
// What a packet or message holds: bytes that stay where their sender has put them until their receiver has taken them,
// while headers travel; and the pool from which PEs of this process and the network take such places.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "emulator/cache_line.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {

/// Greatest payload of packet and message alike.
inline constexpr std::size_t kMostBlockBytes = protocol::kMostMessageBytes;
static_assert(kMostBlockBytes >= protocol::kMostPacketBytes);

/// Where it has one holder, nobody looks at `holders`.
struct Payload {
  alignas(kCacheLine) std::array<std::byte, kMostBlockBytes> bytes;
  std::atomic<std::uint32_t> holders;  ///< of a broadcast's: those who have not taken it yet
};

/// Last in, first out: who takes one finds it in the caches. Any thread may call `take` and `give_back`.
class PayloadPool {
 public:
  /// For PEs: nullptr where none is free. Takes no memory from the heap.
  Payload* take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return nullptr;
    Payload* const payload = free_.back();
    free_.pop_back();
    return payload;
  }
  /// For the network, which makes more where none is free.
  Payload* take_or_make() {
    if (Payload* const payload = take()) return payload;
    const std::lock_guard lock(mutex_);
    chunks_.push_back(std::make_unique<Payload[]>(kChunk));
    free_.reserve(chunks_.size() * kChunk);
    for (std::size_t i = kChunk; i-- > 1;) free_.push_back(&chunks_.back()[i]);
    return &chunks_.back()[0];
  }
  /// By its only holder.
  void give_back(Payload* payload) {
    const std::lock_guard lock(mutex_);
    free_.push_back(payload);
  }
  /// By one of several holders.
  void let_go(Payload* payload) {
    if (payload->holders.fetch_sub(1, std::memory_order_acq_rel) == 1) give_back(payload);
  }
  std::size_t in_use() {
    const std::lock_guard lock(mutex_);
    return chunks_.size() * kChunk - free_.size();
  }

 private:
  static constexpr std::size_t kChunk = 64;

  std::mutex mutex_;
  std::vector<Payload*> free_;  // with room for all
  std::vector<std::unique_ptr<Payload[]>> chunks_;
};

}  // namespace torolux
