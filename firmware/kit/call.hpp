// SPDX-License-Identifier: MIT
// Which operation of all PEs together a message belongs to, in one word that travels with it: PEs that disagree are
// noticed. Enters: what a PE calls; leaves: that word, and the call as C has it, for the text that ends a run.
#pragma once

#include <cstdint>

#include "firmware/kit/words.hpp"

namespace torolux::kit {

class Call {
 public:
  /// None.
  constexpr Call() = default;
  static constexpr Call barrier() { return Call(Kind::barrier, 0, 0, 0); }
  static constexpr Call broadcast(std::uint32_t root) { return Call(Kind::broadcast, root, 0, 0); }
  /// type, operation: a torolux_type and a torolux_operation.
  static constexpr Call reduce(std::uint32_t root, std::uint32_t type, std::uint32_t operation) {
    return Call(Kind::reduce, root, type, operation);
  }
  static constexpr Call all_reduce(std::uint32_t type, std::uint32_t operation) {
    return Call(Kind::all_reduce, 0, type, operation);
  }

  /// The same, as the one that its PE calls after `last`.
  constexpr Call after(Call last) const { return Call((word_ & ~kNumber) | ((last.word_ + kFirst) & kNumber)); }
  /// Whether their PEs had called as many before: calls 512 apart look alike.
  constexpr bool at_place_of(Call other) const { return ((word_ ^ other.word_) & kNumber) == 0; }
  friend constexpr bool operator==(Call, Call) = default;
  friend Words& operator<<(Words& words, Call call);

 private:
  enum class Kind : std::uint32_t { barrier, broadcast, reduce, all_reduce };
  // Bits: 2 of the kind, 3 of the type, 2 of the operation, 9 of the number, modulo 512, 16 of the root.
  static constexpr std::uint32_t kFirst = 1U << 7U;
  static constexpr std::uint32_t kNumber = 0x1FFU << 7U;

  explicit constexpr Call(std::uint32_t word) : word_(word) {}
  constexpr Call(Kind kind, std::uint32_t root, std::uint32_t type, std::uint32_t operation)
      : word_(static_cast<std::uint32_t>(kind) | type << 2U | operation << 5U | root << 16U) {}

  std::uint32_t word_ = 0;
};
static_assert(sizeof(Call) == 4);

}  // namespace torolux::kit
