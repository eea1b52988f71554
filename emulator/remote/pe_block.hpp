// SPDX-License-Identifier: MIT
// The PEs of one rank, of one machine: memory, engine and channels. Words from the network and payloads from other
// ranks enter, news and payloads of the PEs leave.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulator/engines/engine/engine.hpp"
#include "emulator/machine/pe_memory.hpp"
#include "emulator/remote/payload_lanes.hpp"
#include "emulator/remote/processor_end.hpp"
#include "emulator/remote/setup_message.hpp"
#include "emulator/remote/wire.hpp"

namespace torolux::remote {

/// For one thread, which runs PEs itself beside the engine's others.
class PeBlock {
 public:
  /// Throws as Machine's constructor does.
  explicit PeBlock(BlockSetup setup);
  PeBlock(const PeBlock&) = delete;
  PeBlock& operator=(const PeBlock&) = delete;
  ~PeBlock();

  void start(const Start& start);
  /// No PE executes anything any more; their memory stays as it is.
  void stop();
  /// bytes: of a message Kind::words.
  void take_words(std::span<const std::byte> bytes);
  /// bytes: of a message Kind::payloads of that rank. Throws MachineFailure, and names it, where they cannot be.
  void take_payloads(unsigned from, std::span<const std::byte> bytes);
  /// Runs a PE for a millisecond at most, or collects what others have run. False: nothing has run.
  bool run();
  const ByteWriter& news() const { return news_; }
  /// Of news, and of payloads that wait as well.
  std::size_t bytes_to_send() const { return news_.size() + outbox_.bytes(); }
  /// Before the news that tell of them. send: is given each other rank, and a message's bytes.
  void send_payloads(const std::function<void(unsigned, std::span<const std::byte>)>& send);
  /// Rank 0 waits for them.
  bool has_wanted_news() const { return has_wanted_news_; }
  /// Nothing runs here until words come.
  bool rests() const { return is_held_ || active_.empty(); }
  void forget_news();
  /// Something waits for a payload from another rank.
  bool awaits_payload() const { return is_held_ ? asked_.has_value() : awaiting_ != 0; }
  /// In words: for which.
  std::string awaited_payload() const;

  /// Of all its PEs, as archive_counts writes them, behind its CPU time [s] and how many payloads it keeps.
  std::vector<std::byte> figures();
  /// As it stands, as archive_memory writes it.
  std::vector<std::byte> memory(const MemoryPart& part) const;
  std::optional<StackRegisters> registers(unsigned pe);
  void check() { engine_->check(); }

  // ---- Saving and going on ----

  bool can_be_saved() const { return engine_->can_be_saved(); }
  /// Before the start. bytes: of a message Kind::restore.
  void restore(std::span<const std::byte> bytes);
  /// From here to let_go no PE executes anything; all that they have said is in `news`.
  void hold();
  void let_go();
  /// While held. bytes: of a message Kind::ask_kept.
  void ask_kept(std::span<const std::byte> bytes);
  /// For that: what Kind::kept says, once. Nothing: not asked, or something is still under way.
  std::optional<std::vector<std::byte>> kept();
  /// While held: as NiuNetworkSide::save_channel writes it.
  std::vector<std::byte> channel(unsigned pe);
  PeRegisters saved(unsigned pe) { return engine_->save(index_of(pe)); }

 private:
  unsigned index_of(unsigned pe) const;
  void collect(unsigned index);
  void collect_active();
  void activate(unsigned index);
  bool stays_active(unsigned index) const;
  std::optional<PacketName> first_missing() const;
  bool threads_run_pes() const { return threads_ > 1 || !has_waker_; }

  BlockSetup setup_;
  unsigned own_;  // rank
  unsigned threads_;
  PayloadOutbox outbox_;
  PayloadInbox inbox_;
  std::optional<RuledKinds> kinds_;
  PeMemories memory_;
  std::unique_ptr<Engine> engine_;
  bool has_waker_ = false;
  std::vector<ProcessorEnd> ends_;
  std::map<unsigned, unsigned> index_of_;  // by the PE's number
  std::deque<unsigned> active_;            // those that may have news
  std::vector<bool> is_active_;
  std::vector<unsigned> told_;  // those in news_
  std::vector<bool> is_told_;
  std::vector<bool> is_awaiting_;  // a payload
  unsigned awaiting_ = 0;          // PEs
  std::optional<std::vector<PacketName>> asked_;
  std::optional<unsigned> wanted_;
  bool has_wanted_news_ = false;
  bool running_ = false, is_held_ = false;
  double begin_cpu_ = 0;
  ByteWriter news_;
};

}  // namespace torolux::remote
