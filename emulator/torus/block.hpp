// SPDX-License-Identifier: MIT
// What is on its way through torus or bus, a packet of records or a message, and the pool from which all of them come.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "emulator/torus/payload.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {

using BlockIndex = std::uint32_t;
inline constexpr BlockIndex kNoBlock = 0xFFFF'FFFFU;

/// What the torus carries beside the records [bytes]: destination, source, number of records, length, age, CRC-32.
inline constexpr std::uint32_t kPacketHeaderBytes = 16;
/// Flits of a packet with so many bytes of records.
constexpr std::uint32_t flits_of(std::uint32_t bytes, std::uint32_t flit_bytes) {
  return (bytes + kPacketHeaderBytes + flit_bytes - 1) / flit_bytes;
}
/// Destination of a broadcast over the bus.
inline constexpr std::uint16_t kEveryPe = 0xFFFF;
static_assert(kEveryPe > protocol::kFrameBuffer && kEveryPe > protocol::kHost && kEveryPe >= protocol::kMostPes);

/// What a packet in the torus is worth.
enum class Copy : std::uint8_t {
  good,
  bad,       ///< its CRC fails at the router where it is; in the slot of the good copy that will follow
  poisoned,  ///< a bad one that has been passed on, in a slot of its own
};

/// The header, one line of the caches. What it is a header of stays where it is.
struct alignas(kCacheLine) Block {
  std::uint64_t number;   ///< the source's own count in the lower half, the source in the upper: a name for hashes
  std::uint64_t entered;  ///< the outgoing queue to the torus [cycle]
  std::uint64_t kinds;    ///< of a PE's records, as in Command
  Payload* contents;      ///< the pool's that gives it back with the block; nullptr: none, or a bad copy
  BlockIndex next;        ///< of the queue that it stands in
  std::uint16_t source;
  std::uint16_t destination;
  std::uint16_t records;       ///< 0: a message
  std::uint16_t message_kind;  ///< of a message
  std::uint32_t flits;         ///< in the torus, header included, >= 1
  std::uint32_t hops;          ///< links crossed so far
  std::uint32_t bytes;         ///< of the payload
  std::uint16_t released;      ///< of a command: NIU slots that became free with it
  Copy copy;
  std::uint8_t output;  ///< of the router where it is, or to which it is on its way: that it asks for

  bool is_broadcast() const { return destination == kEveryPe; }
  /// All that routers and NIUs look at, without contents.
  void become_bad_copy_of(const Block& good) {
    number = good.number;
    entered = good.entered;
    source = good.source;
    destination = good.destination;
    records = good.records;
    message_kind = good.message_kind;
    flits = good.flits;
    hops = good.hops;
    bytes = good.bytes;
    output = good.output;
    copy = Copy::bad;
  }
  std::span<const std::byte> payload() const { return payload_to_write(); }
  std::span<std::byte> payload_to_write() const {
    return contents != nullptr ? std::span(contents->bytes).first(bytes) : std::span<std::byte>();
  }
};
static_assert(sizeof(Block) == kCacheLine);

/// Blocks by number. Grows as needed and reuses; addresses stay. For one thread, but for the payloads' pool.
class BlockPool {
 public:
  PayloadPool& payloads() { return payloads_; }
  Block& operator[](BlockIndex index) { return chunks_[index / kChunk][index % kChunk]; }
  const Block& operator[](BlockIndex index) const { return chunks_[index / kChunk][index % kChunk]; }

  /// A block with everything zero.
  BlockIndex take() {
    if (free_.empty()) grow();
    const BlockIndex index = free_.back();
    free_.pop_back();
    Block& block = (*this)[index];
    block = {};
    block.next = kNoBlock;
    return index;
  }
  /// Of one that has none, a copy of these.
  void set_payload(BlockIndex index, std::span<const std::byte> contents) {
    Block& block = (*this)[index];
    block.bytes = static_cast<std::uint32_t>(contents.size());
    if (contents.empty()) return;
    block.contents = payloads_.take_or_make();
    std::memcpy(block.contents->bytes.data(), contents.data(), contents.size());
  }
  /// Into the caches: what routers look at.
  void fetch_ahead(BlockIndex index) const { __builtin_prefetch(&(*this)[index], 1); }
  /// Its payload is for several, each of whom adds one to `holders` and lets it go in the end.
  void begin_sharing(BlockIndex index) {
    if (Payload* const shared = (*this)[index].contents) shared->holders.store(1, std::memory_order_relaxed);
  }
  /// Gives the block back.
  void end_sharing(BlockIndex index) {
    if (Payload* const shared = std::exchange((*this)[index].contents, nullptr)) payloads_.let_go(shared);
    give_back(index);
  }
  /// With its payload.
  void give_back(BlockIndex index) {
    Block& block = (*this)[index];
    if (block.contents != nullptr) payloads_.give_back(std::exchange(block.contents, nullptr));
    free_.push_back(index);
  }
  std::size_t in_use() const { return chunks_.size() * kChunk - free_.size(); }
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    std::uint64_t chunks = chunks_.size();
    archive(chunks, free_);
    if constexpr (Archive::kReads) {
      chunks_.clear();
      for (std::uint64_t i = 0; i < chunks && i * kChunk <= kNoBlock - kChunk; ++i) {
        chunks_.push_back(std::make_unique<Block[]>(kChunk));
        archive_chunk(archive, chunks_.back()[0]);
      }
    } else {
      for (auto& chunk : chunks_) archive_chunk(archive, chunk[0]);
    }
  }

 private:
  static constexpr BlockIndex kChunk = 64;

  /// first: of kChunk.
  template <class Archive>
  void archive_chunk(Archive& archive, Block& first) {
    for (Block& block : std::span(&first, kChunk)) {
      Payload* const contents = std::exchange(block.contents, nullptr);  // a place of this process
      bool has_contents = contents != nullptr;
      archive.bytes(std::as_writable_bytes(std::span(&block, 1)));
      archive(has_contents);
      block.contents = Archive::kReads && has_contents ? payloads_.take_or_make() : contents;
      if (block.bytes > kMostBlockBytes) block.bytes = 0;
      archive.bytes(block.payload_to_write());
    }
  }

  void grow() {
    const auto first = static_cast<BlockIndex>(chunks_.size() * kChunk);
    chunks_.push_back(std::make_unique<Block[]>(kChunk));
    for (BlockIndex i = kChunk; i-- > 0;) free_.push_back(first + i);
  }

  PayloadPool payloads_;
  std::vector<std::unique_ptr<Block[]>> chunks_;
  std::vector<BlockIndex> free_;
};

/// First in, first out, linked through the blocks.
class BlockQueue {
 public:
  bool empty() const { return head_ == kNoBlock; }
  std::uint32_t size() const { return size_; }
  BlockIndex front() const { return head_; }
  void push(BlockPool& pool, BlockIndex index) {
    pool[index].next = kNoBlock;
    (head_ == kNoBlock ? head_ : pool[tail_].next) = index;
    tail_ = index;
    ++size_;
  }
  BlockIndex back() const { return empty() ? kNoBlock : tail_; }
  void remove_back(BlockPool& pool) {
    BlockIndex before = kNoBlock;
    for (BlockIndex at = head_; at != tail_; at = pool[at].next) before = at;
    (before == kNoBlock ? head_ : pool[before].next) = kNoBlock;
    tail_ = before;
    --size_;
  }
  BlockIndex pop(BlockPool& pool) {
    const BlockIndex index = head_;
    pop(pool[index]);
    return index;
  }
  /// first: the block at the front.
  void pop(const Block& first) {
    head_ = first.next;
    --size_;
  }

 private:
  BlockIndex head_ = kNoBlock;
  BlockIndex tail_ = kNoBlock;
  std::uint32_t size_ = 0;
};

}  // namespace torolux
