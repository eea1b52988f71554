// SPDX-License-Identifier: MIT
// Basic blocks: which instructions can be reached, where straight runs of them begin and end, and at which of those
// translated code may be entered from outside.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "emulator/engines/translated/decode/code_map.hpp"

namespace torolux::translated {

enum class Ending : std::uint8_t {
  next,         ///< runs into the block behind it
  branch,       ///< conditional: to target or next
  jump,         ///< jal
  indirect,     ///< jalr
  hint,         ///< then next
  interpreted,  ///< the instruction at `end` is not translated and not part of the block
};

struct Block {
  std::uint32_t begin;
  std::uint32_t end;     ///< first address behind it
  std::uint32_t last;    ///< address of the last instruction; meaningless where the block is empty
  std::uint32_t target;  ///< of branch and jump
  Ending ending;
  bool entry;  ///< may be reached from outside its function
  bool taken;  ///< its address stands somewhere: it may be reached by an indirect jump
  Cost cost;   ///< of the whole block
};

/// Whether the code generator leaves this instruction to the interpreter.
bool is_interpreted(const Instruction& instruction);

/// Of its instructions, ascending.
std::vector<std::uint32_t> addresses_in(const CodeMap& code, const Block& block);

class Blocks {
 public:
  Blocks(const Image& image, const CodeMap& code);

  const std::map<std::uint32_t, Block>& all() const { return blocks_; }
  /// Whether the program reads fflags or mstatus anywhere: nobody else sees which flags its arithmetic raises.
  bool observed() const { return observed_; }
  /// Lets the block at this address be entered from outside, if there is one that is not empty.
  void make_entry(std::uint32_t address);
  /// Ascending addresses at which functions begin, as far as symbols and calls tell.
  const std::vector<std::uint32_t>& functions() const { return functions_; }
  /// The one that holds this address, by number; what lies before the first belongs to it.
  std::size_t function_of(std::uint32_t address) const;

 private:
  struct Traits {
    bool reached = false;
    bool leader = false;
    bool entry = false;
    bool taken = false;
    bool function = false;
  };
  Traits& at(std::uint32_t address) { return traits_[(address - code_.begin()) / 2]; }
  void lead(std::uint32_t address, bool entry = false);
  void take(std::uint32_t address);
  void follow(std::uint32_t from);
  void follow_all();
  void fill_functions(const Image& image);
  void divide_long_functions();
  void follow_flow(const Instruction& i, std::uint32_t pc);
  void find_roots(const Image& image);
  void find_constants(std::uint32_t pc, const Instruction& first);
  Block make_block(std::uint32_t begin) const;

  const CodeMap& code_;
  std::vector<Traits> traits_;
  std::vector<std::uint32_t> waiting_;
  std::map<std::uint32_t, Block> blocks_;
  std::vector<std::uint32_t> functions_;
  std::uint32_t end_of_functions_ = 0;  // constants may lie behind
  bool observed_ = false;
};

}  // namespace torolux::translated
