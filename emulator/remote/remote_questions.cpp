// SPDX-License-Identifier: MIT
// What the engine asks ranks for: what their PEs have counted, hold and stand at; and what it gives them to go on with.
#include <sys/mman.h>

#include <algorithm>

#include "emulator/niu/channel_archive.hpp"
#include "emulator/niu/processor_side.hpp"
#include "emulator/ranks/content.hpp"
#include "emulator/remote/counts.hpp"
#include "emulator/remote/remote_engine.hpp"
#include "emulator/snapshot/memory.hpp"

namespace torolux::remote {
namespace {

/// What a mirror holds of its PE's local memory, to this computer: all zeros.
void give_back(const SharedMemory& local) {
  const auto begin = reinterpret_cast<std::uintptr_t>(local.bytes().data());
  const std::uintptr_t first = (begin + protocol::kPageBytes - 1) / protocol::kPageBytes * protocol::kPageBytes;
  const std::uintptr_t end = (begin + local.bytes().size()) / protocol::kPageBytes * protocol::kPageBytes;
  std::ranges::fill(local.bytes().first(first - begin), std::byte{0});
  madvise(local.bytes().data() + (first - begin), end - first, MADV_DONTNEED);
  std::ranges::fill(local.bytes().subspan(end - begin), std::byte{0});
}

}  // namespace

// ---- Questions ----

/// What else comes meanwhile is taken.
ranks::Message RemotePes::answer_of(unsigned rank, Kind kind) {
  for (;;) {
    while (std::optional<ranks::Message> message = others_.poll()) {
      if (message->from == rank && message->kind == static_cast<std::uint32_t>(kind)) return std::move(*message);
      take(*message);
    }
    others_.check_lost();
    others_.wait();
  }
}

void RemotePes::bring_figures() {
  if (stopped_) return;
  tell();  // so that they have all that they may count
  ask_all(Kind::ask_figures);
}

void RemotePes::ask_all(Kind kind) {
  for (Rank& rank : ranks_) {
    rank.answered = false;
    others_.send(rank.number, kind);
  }
  for (const Rank& rank : ranks_) await_answer(rank);
}

void RemotePes::await_answer(const Rank& rank) {
  while (!rank.answered) {
    if (!receive()) others_.wait();
    others_.check_lost();
  }
}

void RemotePes::take_figures(Rank& rank, std::span<const std::byte> bytes) {
  rank.answered = true;
  ranks::read_archive(bytes, [&](SnapshotReader& reader) {
    std::uint64_t kept = 0;
    reader(rank.seconds, kept);
    // Figures are asked for when all PEs are at rest: no news of a packet that a rank has can be on their way.
    if (kept > kept_at(rank).size())
      throw ranks::RankFailure(others_.name_of(rank.number) + " keeps payloads of packets that nobody knows any more");
    for (const unsigned pe : rank.pes) archive_counts(reader, *niu_channel_at(pes_[pe].channel.bytes().data()));
  });
}

double RemotePes::seconds_elsewhere() const {
  double sum = 0;
  for (const Rank& rank : ranks_) sum += rank.seconds;
  return sum;
}

std::optional<StackRegisters> RemotePes::stack_registers(unsigned pe) {
  if (stopped_) return std::nullopt;
  looked_at_ = kNoPe;  // what has been seen of its memory may be old
  const unsigned rank = ranks_[place_[pe]].number;
  others_.send(rank, Kind::ask_registers, ranks::bytes_of(static_cast<std::uint32_t>(pe)));
  return ranks::content_of<std::optional<StackRegisters>>(answer_of(rank, Kind::registers).bytes);
}

/// Whole pages, each once as long as one PE is looked at.
void RemotePes::bring(unsigned pe, std::uint32_t offset, std::uint32_t bytes) {
  const std::uint32_t pages = pes_[pe].local_memory_bytes / protocol::kPageBytes;
  if (looked_at_ != pe) is_page_here_.assign(pages, false);
  looked_at_ = pe;
  const std::uint32_t end = std::min(pages, (offset + bytes + protocol::kPageBytes - 1) / protocol::kPageBytes);
  std::uint32_t first = offset / protocol::kPageBytes;
  while (first < end && is_page_here_[first]) ++first;
  if (first >= end) return;
  const MemoryPart part{pe, first * protocol::kPageBytes, (end - first) * protocol::kPageBytes};
  const unsigned rank = ranks_[place_[pe]].number;
  others_.send(rank, Kind::ask_memory, ranks::bytes_of(part));
  const ranks::Message answer = answer_of(rank, Kind::memory);
  ranks::read_archive(answer.bytes, [&](SnapshotReader& reader) {
    archive_memory(reader, pes_[pe].local.bytes().subspan(part.offset, part.bytes));
  });
  std::fill(is_page_here_.begin() + first, is_page_here_.begin() + end, true);
}

// ---- Saving and going on ----

/// First they are told all that the network has written: what their channels say is then up to date.
void RemotePes::hold() {
  for (unsigned pe = 0; pe < pes_.size(); ++pe) mark(pe);
  tell();
  ask_all(Kind::hold);
  bring_kept();
}

std::vector<StandIns::Entry> RemotePes::kept_at(const Rank& rank) const {
  return stand_ins_.all_for([&](unsigned pe) { return ranks_[place_[pe]].number == rank.number; });
}

/// What is on its way stands here as in one process from now on; and each rank has what PEs have been told of.
void RemotePes::bring_kept() {
  for (Rank& rank : ranks_) {
    rank.asked = kept_at(rank);
    ByteWriter names;
    for (const auto& [place, name] : rank.asked) names.put(name);
    rank.answered = false;
    others_.send(rank.number, Kind::ask_kept, names.bytes());
  }
  for (const Rank& rank : ranks_) await_answer(rank);
}

void RemotePes::let_go() {
  looked_at_ = kNoPe;  // what has been seen of its memory gets old
  for (const Rank& rank : ranks_) others_.send(rank.number, Kind::let_go);
}

bool RemotePes::save_channel(unsigned pe, SnapshotWriter& archive) {
  const unsigned rank = ranks_[place_[pe]].number;
  others_.send(rank, Kind::ask_channel, ranks::bytes_of(static_cast<std::uint32_t>(pe)));
  archive.append(answer_of(rank, Kind::channel).bytes);
  return true;
}

/// This computer need not have the memory of all PEs: one at a time.
PeRegisters RemotePes::save(unsigned pe) {
  if (saved_ != kNoPe) give_back(pes_[saved_].local);
  saved_ = pe;
  looked_at_ = kNoPe;
  const unsigned rank = ranks_[place_[pe]].number;
  others_.send(rank, Kind::ask_saved, ranks::bytes_of(static_cast<std::uint32_t>(pe)));
  return ranks::content_of<PeRegisters>(answer_of(rank, Kind::saved).bytes);
}

/// Its channel and memory stand here as they were saved. A rank gets the next PE once it has taken this one: what has
/// been sent lies in this computer's memory until then.
void RemotePes::restore(unsigned pe, const PeRegisters& registers) {
  Rank& rank = ranks_[place_[pe]];
  await_answer(rank);
  NiuChannel& channel = *niu_channel_at(pes_[pe].channel.bytes().data());
  RestoredPe restored{pe, registers};
  const std::vector<std::byte> bytes = ranks::bytes_of_archive([&](SnapshotWriter& writer) {
    writer(restored);
    archive_channel_state(writer, channel, channel.horizon);
    archive_memory(writer, pes_[pe].local.bytes().first(pes_[pe].local_memory_bytes));
  });
  rank.answered = false;
  others_.send(rank.number, Kind::restore, bytes);
  give_back(pes_[pe].local);
  ends_[pe].resume();
  mark(pe);  // arrivals, and the horizon
}

}  // namespace torolux::remote
