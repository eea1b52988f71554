// SPDX-License-Identifier: MIT
// The profile of one PE: its instructions enter, one by one, and what its HINTs waited; a tree of call paths leaves.
// One thread at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "emulator/niu/channel.hpp"
#include "emulator/profile/call_tree.hpp"
#include "emulator/profile/function_table.hpp"

namespace torolux::profile {

/// How an instruction passed control on (RISC-V Instruction Set Manual, volume I, 20191213, table 2.1: registers x1 and
/// x5 link).
enum class Flow : std::uint8_t {
  on,           ///< to the next instruction, or by a jump or branch that links nothing
  call,         ///< by a jump that links
  back,         ///< by a jump to where a link register points
  swap,         ///< both: to the other of two routines that call each other
  trap,         ///< into the trap handler
  trap_return,  ///< by mret
};

/// A processor behind an instruction.
struct Place {
  std::uint32_t pc;             ///< of the next instruction
  std::uint32_t stack_pointer;  ///< x2
  std::uint64_t clock;          ///< [cycles], the instruction's own counted
};

class PeProfile {
 public:
  /// functions outlives this.
  explicit PeProfile(const FunctionTable& functions) : functions_(&functions) {}

  /// Before the first instruction. clock and waits: what is not to be counted.
  void begin(const Place& place, const WaitCycles& waits);
  bool has_begun() const { return !frames_.empty(); }
  /// After each instruction. link: address behind it.
  void executed(Flow flow, const Place& now, std::uint32_t link) {
    if (flow == Flow::on && now.pc - range_.begin < range_.bytes) return;
    passed_on(flow, now, link);
  }
  /// After each HINT. waits: all that the PE has waited so far; their sum is part of its clock.
  void waited(const WaitCycles& waits);
  /// Whenever the PE stops: all that it has executed is counted.
  void charge(std::uint64_t clock);

  const CallTree& tree() const { return tree_; }
  const FunctionTable& functions() const { return *functions_; }

 private:
  /// A function that has been entered and not been left.
  struct Frame {
    NodeNumber node;
    FunctionNumber function;
    std::uint32_t return_address;  ///< kNowhere: it has none
    std::uint32_t stack_pointer;   ///< at its first instruction
    bool is_trap;                  ///< left by mret
  };
  static constexpr std::uint32_t kNowhere = 1;  // no address of an instruction is odd

  void passed_on(Flow flow, const Place& now, std::uint32_t link);
  void push(const Place& now, std::uint32_t return_address, bool is_trap);
  void replace(const Place& now);
  bool return_to(const Place& now);
  void forget_abandoned(std::uint32_t stack_pointer, std::uint32_t return_address);
  void jump_far(const Place& now);
  void leave_trap();
  Frame& top() { return frames_.back(); }

  const FunctionTable* functions_;
  CallTree tree_;
  std::vector<Frame> frames_;
  CodeRange range_;               // in which the PE is
  std::uint64_t charged_to_ = 0;  // clock up to which all is counted
  WaitCycles waits_{};            // counted
};

}  // namespace torolux::profile
