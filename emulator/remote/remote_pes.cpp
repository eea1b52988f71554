// SPDX-License-Identifier: MIT
// What the network writes into a mirror is gathered until the scheduler has nothing else to do; then each rank gets it
// in one message.
#include "emulator/remote/remote_pes.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "emulator/niu/processor_side.hpp"
#include "emulator/ranks/content.hpp"
#include "emulator/remote/remote_engine.hpp"
#include "emulator/remote/setup_message.hpp"

namespace torolux::remote {
namespace {

/// Into the cache: else each rank of this computer would do that, at the same time.
void translate_once(const MachineSetup& setup, const ImageSet& images) {
  std::vector<PeMemory> none;
  engine_named(setup.engine)({setup.description, images, none, 1});
}

}  // namespace

RemotePes::RemotePes(PeRanks& ranks, const MachineSetup& setup, const ImageSet& images, std::vector<PeMemory>& pes)
    : name_(setup.engine),
      others_(ranks),
      pes_(pes),
      keeps_payloads_(setup.record_watcher == nullptr),
      place_(pes.size()),
      is_marked_(pes.size()) {
  for (const PeMemory& pe : pes) ends_.emplace_back(*niu_channel_at(pe.channel.bytes().data()), stand_ins_);
  const std::vector<unsigned> rank_of = others_.place(static_cast<unsigned>(pes.size()));
  for (unsigned pe = 0; pe < pes.size(); ++pe) {
    auto rank = std::ranges::find(ranks_, rank_of[pe], &Rank::number);
    if (rank == ranks_.end()) rank = ranks_.insert(ranks_.end(), Rank{rank_of[pe]});
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
  BlockPlace place{{}, 1, others_.place(static_cast<unsigned>(pes_.size())), others_.next_machine()};
  for (std::size_t i = 0; i < ranks_.size(); ++i) {
    place.numbers = ranks_[i].pes;
    place.sharers = sharers[i];
    others_.send(numbers[i], Kind::setup, bytes_of_setup(setup, images, place));
  }
  while (!std::ranges::all_of(ranks_, &Rank::ready)) {
    if (!receive()) others_.wait();
    others_.check_lost();
  }
}

/// Payloads stay with the PEs' ranks where nobody looks at them here: only a watcher does, and who counts kinds of
/// records that their senders cannot tell.
void RemotePes::start() {
  Start start{keeps_payloads_, {}};
  const RecordKinds* kinds = niu_channel_at(pes_[0].channel.bytes().data())->record_kinds;
  if (const auto* ruled = dynamic_cast<const HasKindRules*>(kinds))
    start.kind_rules.assign(ruled->kind_rules().begin(), ruled->kind_rules().end());
  if (kinds != nullptr && start.kind_rules.empty()) start.keeps_payloads = false;
  for (const Rank& rank : ranks_) {
    await_answer(rank);
    others_.send(rank.number, Kind::start, ranks::bytes_of(start));
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
    case Kind::kept:
      rank.answered = true;
      if (stand_ins_.fill(std::exchange(rank.asked, {}), message.bytes)) return;
      throw ranks::RankFailure(others_.name_of(message.from) + " has sent other payloads than it was asked for");
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

std::unique_ptr<Engine> make_remote_pes(PeRanks& ranks, const MachineSetup& setup, const ImageSet& images,
                                        std::vector<PeMemory>& pes) {
  return std::make_unique<RemotePes>(ranks, setup, images, pes);
}

}  // namespace torolux::remote
