// SPDX-License-Identifier: MIT
// Executes one instruction at a time, plainly and completely. It is the reference for the translated code, and does
// what that leaves to it: traps, control registers, atomics, odd rounding modes, jumps to unforeseen places.
#pragma once

#include "emulator/engines/translated/decode/code_map.hpp"
#include "emulator/engines/translated/run/control.hpp"
#include "emulator/engines/translated/semantics/pe_state.hpp"

namespace torolux::translated {

class Interpreter {
 public:
  /// code must outlive this.
  explicit Interpreter(const CodeMap& code) : code_(code) {}

  enum class Step : std::uint8_t {
    done,   ///< executed, or trapped into the handler
    hint,   ///< a HINT: counted, pc behind it, pe.hint_immediate set
    stuck,  ///< nothing will ever be executed again: a trap without a handler. pc and mepc say where
    waits,  ///< nor after this: wfi. pc says where
  };
  Step step(TranslatedPe& pe) const;

 private:
  struct Fault {
    Cause cause;
    std::uint32_t value;
  };
  using MaybeFault = std::optional<Fault>;

  Step execute(TranslatedPe& pe, const Instruction& i) const;
  Step trap(TranslatedPe& pe, Cause cause, std::uint32_t value) const;
  bool may_fetch(const TranslatedPe& pe, std::uint32_t address) const;

  MaybeFault memory(TranslatedPe& pe, const Instruction& i) const;
  MaybeFault atomic(TranslatedPe& pe, const Instruction& i) const;
  MaybeFault load(const TranslatedPe& pe, std::uint32_t address, std::uint32_t bytes, std::uint32_t& value) const;
  MaybeFault store(const TranslatedPe& pe, std::uint32_t address, std::uint32_t bytes, std::uint32_t value) const;
  MaybeFault check(const TranslatedPe& pe, std::uint32_t address, std::uint32_t bytes, Access access) const;

  const CodeMap& code_;
};

}  // namespace torolux::translated
