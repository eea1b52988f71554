// SPDX-License-Identifier: MIT
// The PEs of one rank, of one machine: memory, engine and channels. Words from the network enter, news of the PEs
// leave.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "emulator/engines/engine/engine.hpp"
#include "emulator/machine/pe_memory.hpp"
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

  void start();
  /// No PE executes anything any more; their memory stays as it is.
  void stop();
  /// bytes: of a message Kind::words.
  void take_words(std::span<const std::byte> bytes);
  /// Runs a PE for a millisecond at most, or collects what others have run. False: nothing has run.
  bool run();
  const ByteWriter& news() const { return news_; }
  /// Rank 0 waits for them.
  bool has_wanted_news() const { return has_wanted_news_; }
  /// Nothing runs here until words come.
  bool rests() const { return is_held_ || active_.empty(); }
  void forget_news();

  /// Of all its PEs, as archive_counts writes them, behind its CPU time [s].
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
  /// While held: as NiuNetworkSide::save_channel writes it.
  std::vector<std::byte> channel(unsigned pe);
  PeRegisters saved(unsigned pe) { return engine_->save(index_of(pe)); }

 private:
  unsigned index_of(unsigned pe) const;
  void collect(unsigned index);
  void collect_active();
  void activate(unsigned index);
  bool stays_active(unsigned index) const;
  bool threads_run_pes() const { return threads_ > 1 || !has_waker_; }

  BlockSetup setup_;
  unsigned threads_;
  PeMemories memory_;
  std::unique_ptr<Engine> engine_;
  bool has_waker_ = false;
  std::vector<ProcessorEnd> ends_;
  std::map<unsigned, unsigned> index_of_;  // by the PE's number
  std::deque<unsigned> active_;            // those that may have news
  std::vector<bool> is_active_;
  std::vector<unsigned> told_;  // those in news_
  std::vector<bool> is_told_;
  std::optional<unsigned> wanted_;
  bool has_wanted_news_ = false;
  bool running_ = false, is_held_ = false;
  double begin_cpu_ = 0;
  ByteWriter news_;
};

}  // namespace torolux::remote
