// SPDX-License-Identifier: MIT
// What the network writes into a mirror is gathered until the scheduler has nothing else to do; then each rank gets it
// in one message.
#include "emulator/remote/remote_pes.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <exception>
#include <string>

#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "emulator/niu/channel_archive.hpp"
#include "emulator/niu/processor_side.hpp"
#include "emulator/ranks/content.hpp"
#include "emulator/remote/counts.hpp"
#include "emulator/remote/network_end.hpp"
#include "emulator/remote/pe_ranks.hpp"
#include "emulator/remote/setup_message.hpp"
#include "emulator/snapshot/memory.hpp"

namespace torolux::remote {
namespace {

/// Into the cache: else each rank of this computer would do that, at the same time.
void translate_once(const MachineSetup& setup, const ImageSet& images) {
  std::vector<PeMemory> none;
  engine_named(setup.engine)({setup.description, images, none, 1});
}

/// What a mirror holds of its PE's local memory, to this computer: all zeros.
void give_back(const SharedMemory& local) {
  const auto begin = reinterpret_cast<std::uintptr_t>(local.bytes().data());
  const std::uintptr_t first = (begin + protocol::kPageBytes - 1) / protocol::kPageBytes * protocol::kPageBytes;
  const std::uintptr_t end = (begin + local.bytes().size()) / protocol::kPageBytes * protocol::kPageBytes;
  std::ranges::fill(local.bytes().first(first - begin), std::byte{0});
  madvise(local.bytes().data() + (first - begin), end - first, MADV_DONTNEED);
  std::ranges::fill(local.bytes().subspan(end - begin), std::byte{0});
}

class RemotePes final : public Engine, private ProcessorWaker {
 public:
  RemotePes(PeRanks& ranks, const MachineSetup& setup, const ImageSet& images, std::vector<PeMemory>& pes);
  RemotePes(const RemotePes&) = delete;
  RemotePes& operator=(const RemotePes&) = delete;
  ~RemotePes() override { stop(); }

  std::string_view name() const override { return name_; }
  void start() override {
    for (const Rank& rank : ranks_) {
      await_answer(rank);
      others_.send(rank.number, Kind::start);
    }
  }
  void check() override { others_.check_lost(); }
  void stop() override;

  bool can_be_saved() const override { return std::ranges::all_of(ranks_, &Rank::can_be_saved); }
  void hold() override;
  void let_go() override;
  bool save_channel(unsigned pe, SnapshotWriter& archive) override;
  PeRegisters save(unsigned pe) override;
  void restore(unsigned pe, const PeRegisters& registers) override;

  std::optional<StackRegisters> stack_registers(unsigned pe) override;
  void bring_figures() override;
  void bring(unsigned pe, std::uint32_t offset, std::uint32_t bytes) override;
  double seconds_elsewhere() const override;

  ProcessorWaker* waker(unsigned /*pe*/) override { return this; }
  bool help(unsigned pe, std::uint64_t wanted) override;

 private:
  struct Rank {
    unsigned number;
    std::vector<unsigned> pes;
    std::vector<unsigned> to_tell;  // PEs; each once
    unsigned wanted = kNoPe;
    double seconds = 0;
    bool ready = false, can_be_saved = false, stopped = false;
    bool answered = true;  // what all are asked at once
  };

  bool is_far() const override { return true; }
  void told(unsigned pe) override { mark(pe); }
  void wake(unsigned pe) override {
    ends_[pe].wake();
    mark(pe);
  }
  void mark(unsigned pe) {
    if (is_marked_[pe]) return;
    is_marked_[pe] = true;
    ranks_[place_[pe]].to_tell.push_back(pe);
  }
  void begin(const MachineSetup& setup, const ImageSet& images);
  void tell();
  bool receive();
  void take(const ranks::Message& message);
  void take_news(std::span<const std::byte> bytes);
  void take_figures(Rank& rank, std::span<const std::byte> bytes);
  Rank& rank_of_message(const ranks::Message& message);
  ranks::Message answer_of(unsigned rank, Kind kind);
  void ask_all(Kind kind);
  void await_answer(const Rank& rank);

  std::string name_;
  PeRanks& others_;
  std::vector<PeMemory>& pes_;
  std::vector<NetworkEnd> ends_;
  std::vector<Rank> ranks_;           // those that have PEs
  std::vector<std::uint32_t> place_;  // of each PE's rank in ranks_
  std::vector<bool> is_marked_;
  std::vector<bool> is_page_here_;  // of `looked_at_`
  unsigned looked_at_ = kNoPe;
  unsigned saved_ = kNoPe;  // its memory is here
  bool stopped_ = false;
  ByteWriter words_;
};

RemotePes::RemotePes(PeRanks& ranks, const MachineSetup& setup, const ImageSet& images, std::vector<PeMemory>& pes)
    : name_(setup.engine), others_(ranks), pes_(pes), place_(pes.size()), is_marked_(pes.size()) {
  for (const PeMemory& pe : pes) ends_.emplace_back(*niu_channel_at(pe.channel.bytes().data()));
  const std::vector<unsigned> rank_of = others_.place(static_cast<unsigned>(pes.size()));
  for (unsigned pe = 0; pe < pes.size(); ++pe) {
    auto rank = std::ranges::find(ranks_, rank_of[pe], &Rank::number);
    if (rank == ranks_.end()) rank = ranks_.insert(ranks_.end(), Rank{rank_of[pe], {}, {}});
    rank->pes.push_back(pe);
    place_[pe] = static_cast<std::uint32_t>(rank - ranks_.begin());
  }
  try {
    begin(setup, images);
  } catch (...) {
    stop();
    throw;
  }
}

void RemotePes::begin(const MachineSetup& setup, const ImageSet& images) {
  std::vector<unsigned> numbers;
  numbers.reserve(ranks_.size());
  for (const Rank& rank : ranks_) numbers.push_back(rank.number);
  std::vector<unsigned> sharers;
  sharers.reserve(ranks_.size());
  for (const unsigned number : numbers) sharers.push_back(others_.sharers(number, numbers));
  const auto is_here = [this](unsigned number) { return others_.is_here(number); };
  if (setup.engine == kDefaultEngine && std::ranges::any_of(numbers, is_here)) translate_once(setup, images);
  for (std::size_t i = 0; i < ranks_.size(); ++i)
    others_.send(numbers[i], Kind::setup, bytes_of_setup(setup, images, ranks_[i].pes, sharers[i]));
  while (!std::ranges::all_of(ranks_, &Rank::ready)) {
    if (!receive()) others_.wait();
    others_.check_lost();
  }
}

/// Their memories can still be looked at.
void RemotePes::stop() {
  if (stopped_) return;
  stopped_ = true;
  try {
    for (const Rank& rank : ranks_) others_.send(rank.number, Kind::stop);
  } catch (const std::exception&) {
    return;
  }
  std::size_t failures = 0;
  while (!std::ranges::all_of(ranks_, &Rank::stopped) && failures <= ranks_.size()) {
    try {
      if (!receive()) others_.wait();
      others_.check_lost();
    } catch (const std::exception&) {
      ++failures;  // each can fail once; one that is lost does so again and again
    }
  }
}

// ---- News and words ----

bool RemotePes::help(unsigned pe, std::uint64_t /*wanted*/) {
  mark(pe);  // it may be the horizon that it needs
  if (ends_[pe].ask()) ranks_[place_[pe]].wanted = pe;
  tell();
  if (receive()) return true;
  others_.wait();
  receive();
  return true;
}

void RemotePes::tell() {
  for (Rank& rank : ranks_) {
    if (rank.to_tell.empty()) continue;
    words_.clear();
    words_.put(WordsBegin{rank.wanted, 0});
    bool any = rank.wanted != kNoPe;
    for (const unsigned pe : rank.to_tell) {
      is_marked_[pe] = false;
      any = ends_[pe].collect(pe, words_) || any;
    }
    rank.to_tell.clear();
    rank.wanted = kNoPe;
    if (any) others_.send(rank.number, Kind::words, words_.bytes());
  }
}

/// True: something was there.
bool RemotePes::receive() {
  bool any = false;
  while (const std::optional<ranks::Message> message = others_.poll()) {
    take(*message);
    any = true;
  }
  return any;
}

RemotePes::Rank& RemotePes::rank_of_message(const ranks::Message& message) {
  const auto rank = std::ranges::find(ranks_, message.from, &Rank::number);
  if (rank == ranks_.end()) throw ranks::RankFailure(others_.name_of(message.from) + " speaks, but has no PEs");
  return *rank;
}

void RemotePes::take(const ranks::Message& message) {
  Rank& rank = rank_of_message(message);
  switch (static_cast<Kind>(message.kind)) {
    case Kind::ready:
      rank.ready = true;
      rank.can_be_saved = ranks::content_of<bool>(message.bytes);
      return;
    case Kind::restored:
    case Kind::held:
      rank.answered = true;
      return;
    case Kind::stopped:
      rank.stopped = true;
      return;
    case Kind::news:
      return take_news(message.bytes);
    case Kind::figures:
      return take_figures(rank, message.bytes);
    default:
      throw ranks::RankFailure(others_.name_of(message.from) + " has sent a message of kind " +
                               std::to_string(message.kind));
  }
}

void RemotePes::take_news(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  while (!reader.empty()) {
    const auto news = reader.get<News>();
    ends_.at(news.pe).take(news, reader);
  }
}

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
    reader(rank.seconds);
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

void refuse(bool asked, const std::string& what, const std::string& instead) {
  if (asked) throw UsageError(what + " does not go with PEs on other ranks: " + instead);
}

}  // namespace

void check_goes_with_ranks(const MachineSetup& setup) {
  const std::string alone = "start it without mpirun";
  const Debugging& debugging = setup.debugging;
  refuse(setup.engine == kQemuEngine || !debugging.qemu_pes.empty(), "the engine qemu",
         "take the engine translated, interpreted or auto, or " + alone);
  refuse(!debugging.gdb.empty() || debugging.own || debugging.debugger != nullptr, "a debugger", alone);
  refuse(setup.profile != nullptr, "a profile of instructions", alone);
  refuse(setup.watcher != nullptr, "a trace of the PEs' states", alone);
}

std::unique_ptr<Engine> make_remote_pes(PeRanks& ranks, const MachineSetup& setup, const ImageSet& images,
                                        std::vector<PeMemory>& pes) {
  return std::make_unique<RemotePes>(ranks, setup, images, pes);
}

}  // namespace torolux::remote
