// SPDX-License-Identifier: MIT
// Writes and reads the log of HINTs.
#include "emulator/engines/qemu/hint_log.hpp"

#include <atomic>
#include <cstring>

#include "emulator/engines/qemu/hint_effects.hpp"

namespace torolux {
namespace {

using protocol::NiuWindow;

constexpr std::size_t padded(std::size_t bytes) {
  return (bytes + 7) / 8 * 8;
}

/// The most that one entry takes: the window, and a full packet of records in separate slots.
constexpr std::size_t kLargestEntry =
    sizeof(HintLogEntry) + 2 * sizeof(NiuWindow) + protocol::kMostPacketBytes + 32 * (sizeof(HintLogPatch) + 8);

}  // namespace

HintRecorder::HintRecorder(std::span<std::byte> log, std::span<const std::byte> local_memory,
                           std::uint32_t window_offset)
    : log_(log.subspan(sizeof(HintLogHead))),
      local_memory_(local_memory),
      window_offset_(window_offset),
      head_(*reinterpret_cast<HintLogHead*>(log.data())) {
  std::uint32_t patches = 0;
  auto* entry = reinterpret_cast<HintLogEntry*>(take(sizeof(HintLogEntry)));
  patch(window_offset, sizeof(NiuWindow), patches);
  *entry = {0, 0, patches};
  head_.whole = 1;
}

std::byte* HintRecorder::take(std::size_t bytes) {
  std::byte* place = log_.data() + head_.used;
  head_.used += padded(bytes);
  return place;
}

void HintRecorder::patch(std::uint32_t offset, std::uint32_t bytes, std::uint32_t& patches) {
  const HintLogPatch head{offset, bytes};
  std::memcpy(take(sizeof head), &head, sizeof head);
  std::memcpy(take(bytes), local_memory_.data() + offset, bytes);
  ++patches;
}

void HintRecorder::happened(std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions) {
  if (protocol::is_phase_marker(immediate) || head_.whole == 0) {
    return;
  }
  if (log_.size() - head_.used < kLargestEntry) {
    head_.whole = 0;
    return;
  }
  std::uint32_t patches = 0;
  auto* entry = reinterpret_cast<HintLogEntry*>(take(sizeof(HintLogEntry)));
  for_each_written(immediate, local_memory_, window_offset_,
                   [&](std::uint32_t offset, std::uint32_t bytes) { patch(offset, bytes, patches); });
  *entry = {clock, immediate, patches};
  head_.cycles = clock;
  head_.instructions = instructions;
}

HintReplayer::HintReplayer(std::span<std::byte> log, std::span<std::byte> local_memory)
    : head_(*reinterpret_cast<HintLogHead*>(log.data())),
      entries_(log.subspan(sizeof(HintLogHead), head_.used)),
      local_memory_(local_memory) {
  if (!at_end()) {
    apply();
  }
}

HintLogEntry HintReplayer::apply() {
  HintLogEntry entry{};
  std::memcpy(&entry, &entries_[next_], sizeof entry);
  next_ += padded(sizeof entry);
  for (std::uint32_t i = 0; i < entry.patches; ++i) {
    HintLogPatch head{};
    std::memcpy(&head, &entries_[next_], sizeof head);
    next_ += padded(sizeof head);
    std::memcpy(&local_memory_[head.offset], &entries_[next_], head.bytes);
    next_ += padded(head.bytes);
  }
  return entry;
}

NiuProcessorSide::Result HintReplayer::hint(std::int32_t immediate, std::uint64_t clock) {
  using enum NiuProcessorSide::Outcome;
  if (protocol::is_phase_marker(immediate)) {
    return {done, clock};
  }
  if (at_end()) {
    std::atomic_ref(head_.replayed).store(1);
    return {stop, clock};
  }
  HintLogEntry expected{};
  std::memcpy(&expected, &entries_[next_], sizeof expected);
  if (expected.immediate != immediate || expected.clock < clock) {
    return {stop, clock};  // at_end() is false: the run did not repeat itself
  }
  apply();
  return {done, expected.clock};
}

}  // namespace torolux
