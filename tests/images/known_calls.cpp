// SPDX-License-Identifier: MIT
// An image whose calls and cycles are known, for the profile: what PE 0 does in assembler takes the cycles that stand
// beside each function, with the built-in latencies. Built with -msave-restore. Its test: profile_test.cpp.
#include <csetjmp>

#include "firmware/boot/boot.hpp"

namespace torolux::tests {
namespace {

asm(R"(
  .macro function name
  .globl \name
  .type \name, @function
\name:
  .endm
  .macro end_function name
  .size \name, . - \name
  .endm

  .section .text.calls, "ax"
  function leaf                # 3
  addi a0, a0, 1
  ret
  end_function leaf

  function countdown           # 12 for each level, 9 for the last, which a0 = 0 is
  addi sp, sp, -16
  sw   ra, 12(sp)
  beqz a0, 1f
  addi a0, a0, -1
  jal  ra, countdown
1:
  lw   ra, 12(sp)
  addi sp, sp, 16
  ret
  end_function countdown

  function by_tail             # 3; then leaf in its place
  addi a0, a0, 1
  j    leaf
  end_function by_tail

  function by_pointer          # 8; the function that a1 points to
  mv   t2, ra
  nop
  nop
  jalr ra, 0(a1)
  mv   ra, t2
  ret
  end_function by_pointer

  function by_other_link       # 8; its helper is a part of it: a label is no function
  mv   t1, a0
  jal  t0, 2f
  add  a0, a0, t1
  ret
2:
  jr   t0
  end_function by_other_link

  function all_calls           # 21: by_tail, by_pointer of leaf, countdown(3), by_other_link twice
  addi sp, sp, -16
  sw   ra, 12(sp)
  jal  ra, by_tail
  lui  a1, %hi(leaf)
  addi a1, a1, %lo(leaf)
  jal  ra, by_pointer
  li   a0, 3
  jal  ra, countdown
  li   a0, 5
  jal  ra, by_other_link
  jal  ra, by_other_link
  lw   ra, 12(sp)
  addi sp, sp, 16
  ret
  end_function all_calls
  .text
)");
extern "C" {
std::uint32_t all_calls();
std::uint32_t leaf(std::uint32_t);
}

struct Record {
  std::uint32_t value;
  std::uint32_t unused;
};
constexpr std::uint32_t kOwnSlots = 1;

jmp_buf landing;

/// Leaves `levels` calls at once, where it is told to.
// NOLINTNEXTLINE(misc-no-recursion): the way to many frames
extern "C" [[gnu::noinline]] std::uint32_t climbs(std::uint32_t levels) {
  if (levels == 0 && leaf(0) != 0) longjmp(landing, 1);  // NOLINT(cert-err52-cpp): what is tested
  if (levels == 0) return 0;
  return leaf(climbs(levels - 1));
}

extern "C" [[gnu::noinline]] std::uint32_t lands() {
  if (setjmp(landing) == 0) return climbs(3);  // NOLINT(cert-err52-cpp)
  return leaf(1);
}

/// Keeps more than one register over its calls: helpers save and restore them.
extern "C" [[gnu::noinline]] std::uint32_t keeps(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const std::uint32_t first = leaf(a);
  const std::uint32_t second = leaf(b);
  return first + second + leaf(c);
}

extern "C" [[gnu::noinline]] pe::Slot waits_for_it(pe::Niu& niu) {
  return niu.receive().slots[0];
}

}  // namespace
}  // namespace torolux::tests

void torolux::pe::pe_main(Niu& niu) {
  using namespace torolux::tests;
  niu.set_slots(niu.memory().stores_begin(), sizeof(Record), kOwnSlots, protocol::kMostRecordsPerPacket);
  if (niu.pe() != 0U) {
    niu.release(waits_for_it(niu));
    return;
  }
  const Slot slot = 0;
  niu.memory().at<Record>(niu.memory().stores_begin())[slot].value = all_calls() + lands() + keeps(1, 2, 3);
  for (PeNumber pe = 1; pe < niu.pes(); ++pe) niu.send_records(pe, std::span(&slot, 1));
}
