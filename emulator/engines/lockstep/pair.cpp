// SPDX-License-Identifier: MIT
// QEMU comes to a HINT first; then the shadow runs there; then they are compared, while neither moves.
#include "emulator/engines/lockstep/pair.hpp"

#include <chrono>

#include "emulator/engines/lockstep/difference.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/futex.hpp"

namespace torolux::lockstep {
namespace {

constexpr std::chrono::microseconds kLongestSleep{50'000};
/// The shadow may go on so many cycles beyond the clock at which QEMU met a HINT.
constexpr std::uint64_t kMostCyclesMore = 1'000'000;

std::span<std::byte> local_memory(const PeMemory& memory) {
  return memory.local.bytes().first(memory.local_memory_bytes);
}

}  // namespace

Pair::Pair(const Common& common, unsigned number, SharedMemory& meeting)
    : common_(common),
      number_(number),
      local_(common.setup.pes[number].local),
      meeting_(*reinterpret_cast<HintMeeting*>(meeting.bytes().data())),
      window_offset_(common.setup.images.of(number).niu_window - protocol::kLocalMemoryBase),
      niu_(*niu_channel_at(common.setup.pes[number].channel.bytes().data()), local_memory(common.setup.pes[number]),
           window_offset_),
      shadow_(common.code, local_, common.setup.pes[number].local_memory_bytes, niu_) {}

void Pair::start() {
  thread_ = std::thread([this] { work(); });
}

void Pair::end() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();
}

std::optional<std::string> Pair::difference() const {
  const std::lock_guard lock(mutex_);
  return difference_;
}

/// False: the machine ends.
bool Pair::await_qemu() {
  while (meeting_.turn.load() != HintMeeting::of_emulator) {
    if (ending_) return false;
    futex_wait(meeting_.turn, HintMeeting::of_qemu, kLongestSleep);
  }
  return true;
}

void Pair::work() {
  while (await_qemu()) {
    if (!compare()) return;  // QEMU stays where it is, until the engine is stopped
    take_hint();
    const bool stops = meeting_.stop != 0;
    meeting_.turn.store(HintMeeting::of_qemu);
    futex_wake(meeting_.turn);
    if (stops) return;
  }
}

bool Pair::compare() {
  const TranslatedImage::Stop stop = shadow_.run(meeting_.clock + kMostCyclesMore);
  ++totals_.hints;
  const auto found = find_difference(meeting_, shadow_, stop);
  if (!found) {
    totals_.markers = meeting_.markers.count;
    totals_.instructions = meeting_.instructions;
    for (const MemoryRange& range : shadow_.memories().touched()) totals_.bytes += range.end - range.begin;
    return true;
  }
  const PeInQuestion pe{number_,      totals_.hints, last_hint_clock_, common_.setup.images.of(number_),
                        common_.code, common_.map};
  std::string text = report(pe, *found, meeting_, shadow_, local_.bytes());
  const std::lock_guard lock(mutex_);
  difference_ = std::move(text);
  return false;
}

/// On QEMU's memory; what it writes there the shadow takes over.
void Pair::take_hint() {
  using enum NiuProcessorSide::Outcome;
  NiuProcessorSide::Result result{retry, meeting_.clock};
  while (result.outcome == retry) {
    result = niu_.hint(meeting_.immediate, meeting_.clock, meeting_.instructions);
    if (result.outcome == retry && ending_) result.outcome = stop;
  }
  meeting_.stop = result.outcome == stop ? 1 : 0;
  meeting_.clock = result.clock;
  last_hint_clock_ = result.clock;
  if (result.outcome == done) shadow_.follow(local_.bytes(), window_offset_, result.clock);
}

}  // namespace torolux::lockstep
