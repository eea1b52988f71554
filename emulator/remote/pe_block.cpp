// SPDX-License-Identifier: MIT
// What Machine and Emulation do for PEs of their own process, as far as it does not concern the network.
#include "emulator/remote/pe_block.hpp"

#include <sched.h>

#include <algorithm>
#include <ctime>
#include <string>
#include <thread>

#include "emulator/clock_seconds.hpp"
#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "emulator/niu/network_side.hpp"
#include "emulator/niu/processor_side.hpp"
#include "emulator/ranks/content.hpp"
#include "emulator/remote/counts.hpp"
#include "emulator/snapshot/memory.hpp"

namespace torolux::remote {

using ranks::bytes_of_archive;
using ranks::read_archive;

namespace {

/// That this process may use: launchers often allow it one of a computer's.
unsigned allowed_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return std::max(1U, std::thread::hardware_concurrency());
  return static_cast<unsigned>(std::max(1, CPU_COUNT(&set)));
}

unsigned threads_of(const BlockSetup& setup) {
  if (setup.machine.threads != 0) return setup.machine.threads;
  return std::max(1U, allowed_cores() / std::max(1U, setup.place.sharers));
}

}  // namespace

PeBlock::PeBlock(BlockSetup setup)
    : setup_(std::move(setup)),
      own_(setup_.place.rank_of.at(setup_.place.numbers.at(0))),
      threads_(threads_of(setup_)),
      outbox_(setup_.place.machine_number, setup_.place.rank_of),
      inbox_(setup_.place.machine_number, setup_.place.rank_of, own_),
      is_active_(setup_.place.numbers.size()),
      is_told_(setup_.place.numbers.size()),
      is_awaiting_(setup_.place.numbers.size()),
      begin_cpu_(clock_seconds(CLOCK_PROCESS_CPUTIME_ID)) {
  const MachineSetup& machine = setup_.machine;
  const unsigned pes = machine.columns * machine.rows;
  for (unsigned index = 0; index < setup_.place.numbers.size(); ++index) index_of_[setup_.place.numbers[index]] = index;
  memory_ = make_pes(machine, setup_.images, setup_.place.numbers, std::vector<bool>(pes));
  engine_ = engine_named(machine.engine)({machine.description, setup_.images, memory_.pes, threads_});
  has_waker_ = engine_->waker(0) != nullptr;
  for (unsigned index = 0; index < setup_.place.numbers.size(); ++index) {
    NiuChannel& channel = *niu_channel_at(memory_.pes[index].channel.bytes().data());
    set_up_channel(channel, pes, machine.description, has_waker_);
    channel.until = machine.until;
    ends_.emplace_back(channel, setup_.place.numbers[index], index, engine_->waker(index));
  }
}

PeBlock::~PeBlock() {
  stop();
}

void PeBlock::stop() {
  if (!running_) return;
  running_ = false;
  for (ProcessorEnd& end : ends_) end.tell_to_stop();
  engine_->stop();
}

/// PEs that are asked for kinds tell them as those of one process do.
void PeBlock::start(const Start& start) {
  const auto is_inside = [](const KindRule& rule) { return rule.at < rule.record_bytes; };
  if (!std::ranges::all_of(start.kind_rules, is_inside)) throw MachineFailure("rank 0 tells kinds that cannot be");
  if (!start.kind_rules.empty()) kinds_.emplace(start.kind_rules);
  for (ProcessorEnd& end : ends_) {
    end.channel().record_kinds = kinds_ ? &*kinds_ : nullptr;
    if (start.keeps_payloads) end.keep_payloads();
  }
  engine_->start();
  running_ = true;
  for (unsigned index = 0; index < ends_.size(); ++index) activate(index);
}

unsigned PeBlock::index_of(unsigned pe) const {
  const auto found = index_of_.find(pe);
  if (found == index_of_.end())
    throw MachineFailure("rank 0 asks for PE " + std::to_string(pe) + ", which is elsewhere");
  return found->second;
}

void PeBlock::activate(unsigned index) {
  if (is_active_[index]) return;
  is_active_[index] = true;
  active_.push_back(index);
}

void PeBlock::take_words(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  const auto begin = reader.get<WordsBegin>();
  while (!reader.empty()) {
    const auto words = reader.get<Words>();
    const unsigned index = index_of(words.pe);
    ends_[index].take(words, reader);
    collect(index);  // what there was no room for, or what it says meanwhile
    if (stays_active(index)) activate(index);
  }
  if (begin.wanted == kNoPe) return;
  const unsigned wanted = index_of(begin.wanted);
  if (is_told_[wanted]) {
    has_wanted_news_ = true;
  } else if (is_active_[wanted]) {
    wanted_ = wanted;
  }
}

void PeBlock::take_payloads(unsigned from, std::span<const std::byte> bytes) {
  inbox_.read(from, bytes, [this](const PacketName& name, std::span<const std::byte> payload) {
    const unsigned index = index_of(name.destination);
    ArrivalLine& line = ends_[index].arrivals();
    const auto awaited = line.awaited();
    line.keep(name, payload);
    if (is_held_ || !awaited || line.awaited() == awaited) return;
    collect(index);
    if (stays_active(index)) activate(index);
  });
}

/// Those for PEs of this rank are here.
void PeBlock::send_payloads(const std::function<void(unsigned, std::span<const std::byte>)>& send) {
  std::vector<std::byte> own;
  outbox_.send_all([&](unsigned rank, std::span<const std::byte> bytes) {
    if (rank != own_) return send(rank, bytes);
    own.assign(bytes.begin(), bytes.end());
  });
  if (!own.empty()) take_payloads(own_, own);
}

std::optional<PacketName> PeBlock::first_missing() const {
  for (const ProcessorEnd& end : ends_) {
    if (const auto name = end.arrivals().missing()) return name;
  }
  if (!asked_) return std::nullopt;
  for (const PacketName& name : *asked_) {
    if (!ends_[index_of(name.destination)].arrivals().has(name)) return name;
  }
  return std::nullopt;
}

std::string PeBlock::awaited_payload() const {
  const auto name = first_missing();
  if (!name) return "nothing";
  return "a packet's payload, of PE " + std::to_string(name->source) + " to PE " + std::to_string(name->destination) +
         ", has not come from rank " + std::to_string(setup_.place.rank_of.at(name->source));
}

void PeBlock::collect(unsigned index) {
  const std::size_t before = news_.size();
  ends_[index].collect(news_, outbox_);
  const bool awaits = ends_[index].arrivals().awaited().has_value();
  if (awaits != is_awaiting_[index]) awaiting_ += awaits ? 1U : -1U;
  is_awaiting_[index] = awaits;
  if (news_.size() == before) return;
  if (!is_told_[index]) told_.push_back(index);
  is_told_[index] = true;
  if (wanted_ != index) return;
  has_wanted_news_ = true;
  wanted_.reset();
}

/// One whose processor sleeps on its channel wakes up by itself now and then, and may go on.
bool PeBlock::stays_active(unsigned index) const {
  return !has_waker_ || !ends_[index].rests();
}

/// Those that rest are none of the active ones any more.
void PeBlock::collect_active() {
  for (std::size_t i = active_.size(); i > 0; --i) {
    const unsigned index = active_.front();
    active_.pop_front();
    collect(index);
    is_active_[index] = stays_active(index);
    if (is_active_[index]) active_.push_back(index);
  }
}

bool PeBlock::run() {
  if (is_held_) return false;
  if (wanted_ && !is_active_[*wanted_]) wanted_.reset();
  if (active_.empty()) return false;
  const unsigned index = wanted_.value_or(active_.front());
  const bool ran = engine_->help(index, kNever - 1);
  if (threads_run_pes()) {
    collect_active();
    return ran;
  }
  active_.erase(std::ranges::find(active_, index));
  collect(index);
  is_active_[index] = stays_active(index);
  if (is_active_[index]) active_.push_back(index);
  return ran;
}

void PeBlock::forget_news() {
  news_.clear();
  for (const unsigned index : told_) is_told_[index] = false;
  told_.clear();
  has_wanted_news_ = false;
}

std::vector<std::byte> PeBlock::figures() {
  double seconds = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - begin_cpu_;
  std::uint64_t kept = 0;
  for (const ProcessorEnd& end : ends_) kept += end.arrivals().unnamed();
  return bytes_of_archive([&](SnapshotWriter& writer) {
    writer(seconds, kept);
    for (ProcessorEnd& end : ends_) archive_counts(writer, end.channel());
  });
}

std::vector<std::byte> PeBlock::memory(const MemoryPart& part) const {
  const auto local = memory_.pes[index_of(part.pe)].local.bytes().first(setup_.machine.local_memory_bytes);
  if (part.offset > local.size() || part.bytes > local.size() - part.offset || part.bytes % protocol::kPageBytes != 0)
    throw MachineFailure("rank 0 asks for memory that PE " + std::to_string(part.pe) + " does not have");
  return bytes_of_archive(
      [&](SnapshotWriter& writer) { archive_memory(writer, local.subspan(part.offset, part.bytes)); });
}

std::optional<StackRegisters> PeBlock::registers(unsigned pe) {
  return engine_->stack_registers(index_of(pe));
}

// ---- Saving and going on ----

void PeBlock::restore(std::span<const std::byte> bytes) {
  read_archive(bytes, [&](SnapshotReader& reader) {
    RestoredPe pe;
    reader(pe);
    const unsigned index = index_of(pe.number);
    ends_[index].restore(reader);
    archive_memory(reader, memory_.pes[index].local.bytes().first(setup_.machine.local_memory_bytes));
    engine_->restore(index, pe.registers);
  });
}

void PeBlock::hold() {
  engine_->hold();
  is_held_ = true;
  for (unsigned index = 0; index < ends_.size(); ++index) collect(index);
}

/// Each looks again.
void PeBlock::let_go() {
  is_held_ = false;
  engine_->let_go();
  for (unsigned index = 0; index < ends_.size(); ++index) activate(index);
}

void PeBlock::ask_kept(std::span<const std::byte> bytes) {
  asked_.emplace();
  for (ByteReader reader(bytes); !reader.empty();) asked_->push_back(reader.get<PacketName>());
}

/// What is saved has the payloads of all that words have named.
std::optional<std::vector<std::byte>> PeBlock::kept() {
  if (!asked_ || first_missing()) return std::nullopt;
  ByteWriter payloads;
  for (const PacketName& name : *asked_) payloads.put_bytes(ends_[index_of(name.destination)].arrivals().give(name));
  asked_.reset();
  return std::vector<std::byte>(payloads.bytes().begin(), payloads.bytes().end());
}

std::vector<std::byte> PeBlock::channel(unsigned pe) {
  ProcessorEnd& end = ends_[index_of(pe)];
  return bytes_of_archive([&end](SnapshotWriter& writer) { end.save(writer); });
}

}  // namespace torolux::remote
