// SPDX-License-Identifier: MIT
// The engine of a machine whose PEs other ranks run, as its parts see it: its mirrors, and the ranks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/engines/engine/engine.hpp"
#include "emulator/machine/machine.hpp"
#include "emulator/remote/network_end.hpp"
#include "emulator/remote/pe_ranks.hpp"
#include "emulator/remote/stand_ins.hpp"

namespace torolux::remote {

class RemotePes final : public Engine, private ProcessorWaker {
 public:
  RemotePes(PeRanks& ranks, const MachineSetup& setup, const ImageSet& images, std::vector<PeMemory>& pes);
  RemotePes(const RemotePes&) = delete;
  RemotePes& operator=(const RemotePes&) = delete;
  ~RemotePes() override { stop(); }

  std::string_view name() const override { return name_; }
  void start() override;
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
    std::vector<unsigned> pes = {};
    std::vector<unsigned> to_tell = {};  // PEs; each once
    unsigned wanted = kNoPe;
    double seconds = 0;
    std::vector<StandIns::Entry> asked = {};  // whose payloads it is to send
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
  std::vector<StandIns::Entry> kept_at(const Rank& rank) const;
  void bring_kept();
  Rank& rank_of_message(const ranks::Message& message);
  ranks::Message answer_of(unsigned rank, Kind kind);
  void ask_all(Kind kind);
  void await_answer(const Rank& rank);

  std::string name_;
  PeRanks& others_;
  std::vector<PeMemory>& pes_;
  bool keeps_payloads_;
  StandIns stand_ins_;
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

}  // namespace torolux::remote
