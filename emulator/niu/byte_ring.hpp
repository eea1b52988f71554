// SPDX-License-Identifier: MIT
// A ring of bytes for one writer and one reader, in memory that two processes may share. Entries are a header
// and its payload, each contiguous; enters at `push`, leaves in the same order at `front` and `pop`.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

namespace torolux {

static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "shared between processes");

/// Of an entry in its ring.
template <class Header>
std::span<const std::byte> payload_behind(const Header& header) {
  return {reinterpret_cast<const std::byte*>(&header) + sizeof header, header.bytes};
}

/// Header: a struct that begins with `std::uint64_t time` and has `std::uint32_t bytes`, the payload's length.
/// Zeroed memory is an empty ring. kMostBytes: a power of two. An entry that finds the ring empty lies at its start: a
/// thousand rings that are mostly empty then live in the caches, and not each of their bytes in turn. Its bytes lie
/// kBehind bytes behind the ring's own beginning, or nearer: several rings that do not use all of theirs lie densely.
template <class Header, std::uint32_t kMostBytes, std::size_t kBehind>
class ByteRing {
  static_assert((kMostBytes & (kMostBytes - 1)) == 0 && sizeof(Header) % 8 == 0);

 public:
  static constexpr std::size_t entry_bytes(std::size_t payload) { return sizeof(Header) + (payload + 7) / 8 * 8; }

  /// Of its bytes, only so many are used: a power of two, at most kMostBytes. nearer: by how much they lie nearer than
  /// kBehind. Before all else.
  void set_bytes(std::uint32_t bytes, std::uint32_t nearer) {
    halvings_ = static_cast<std::uint32_t>(std::countr_zero(kMostBytes / bytes));
    nearer_ = nearer;
  }

  /// Both ends, into the caches.
  void fetch_ahead() const {
    __builtin_prefetch(&written_, 1);
    __builtin_prefetch(&read_, 1);
    __builtin_prefetch(data(), 1);
  }

  // ---- writer ----

  /// Whether an entry with so much payload fits, wherever it comes to lie.
  bool has_room(std::size_t payload) const {
    const std::size_t used = written_.load(std::memory_order_relaxed) - read_.load(std::memory_order_seq_cst);
    return bytes() - used >= 2 * entry_bytes(payload);
  }
  /// Only after has_room(payload.size()).
  void push(Header header, std::span<const std::byte> payload) {
    header.bytes = static_cast<std::uint32_t>(payload.size());
    std::uint64_t at = written_.load(std::memory_order_relaxed);
    if (read_.load(std::memory_order_acquire) == at) start_ = at;  // the reader looks at it once it sees an entry
    const std::size_t entry = entry_bytes(payload.size());
    if (bytes() - place(at) < entry) {
      const std::uint64_t skip = kSkip;
      std::memcpy(&data()[place(at)], &skip, sizeof skip);
      at += bytes() - place(at);
    }
    std::memcpy(&data()[place(at)], &header, sizeof header);
    if (!payload.empty()) std::memcpy(&data()[place(at)] + sizeof header, payload.data(), payload.size());
    written_.store(at + entry, std::memory_order_release);
  }

  // ---- reader ----

  bool empty() const { return written_.load(std::memory_order_seq_cst) == read_.load(std::memory_order_relaxed); }
  /// The oldest entry, or nullptr. Valid until `pop`.
  const Header* front() {
    if (empty()) return nullptr;
    std::uint64_t at = read_.load(std::memory_order_relaxed);
    std::uint64_t time = 0;
    std::memcpy(&time, &data()[place(at)], sizeof time);
    if (time == kSkip) {
      at += bytes() - place(at);
      read_.store(at, std::memory_order_release);
    }
    return reinterpret_cast<const Header*>(&data()[place(at)]);
  }
  static std::span<const std::byte> payload(const Header& header) { return payload_behind(header); }
  /// Calls `each` with every entry, oldest first, which all stay.
  template <class Each>
  void for_each(Each each) const {
    const std::uint64_t end = written_.load(std::memory_order_acquire);
    for (std::uint64_t at = read_.load(std::memory_order_relaxed); at != end;) {
      std::uint64_t time = 0;
      std::memcpy(&time, &data()[place(at)], sizeof time);
      if (time == kSkip) at += bytes() - place(at);
      const Header& header = *reinterpret_cast<const Header*>(&data()[place(at)]);
      each(header);
      at += entry_bytes(header.bytes);
    }
  }
  /// Removes the entry that `front` gave.
  void pop(const Header& header) {
    read_.store(read_.load(std::memory_order_relaxed) + entry_bytes(header.bytes), std::memory_order_release);
  }

 private:
  /// In place of a time: the next entry begins at the ring's start.
  static constexpr std::uint64_t kSkip = std::numeric_limits<std::uint64_t>::max();

  std::byte* data() { return reinterpret_cast<std::byte*>(this) + (kBehind - nearer_); }
  const std::byte* data() const { return reinterpret_cast<const std::byte*>(this) + (kBehind - nearer_); }
  std::size_t bytes() const { return kMostBytes >> halvings_; }
  std::size_t place(std::uint64_t at) const { return (at - start_) & (bytes() - 1); }

  alignas(64) std::atomic<std::uint64_t> written_;  ///< bytes ever written, gaps included
  std::uint64_t start_;                             ///< those before the ring's start; the writer's
  std::uint32_t halvings_, nearer_;                 ///< who needs one of these needs all, so they share a line
  alignas(64) std::atomic<std::uint64_t> read_;     ///< bytes ever read
};

/// Size of each ring, without its bytes.
inline constexpr std::size_t kRingBytes = 128;

}  // namespace torolux
