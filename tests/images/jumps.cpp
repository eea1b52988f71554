// SPDX-License-Identifier: MIT
// An image that jumps in every legal way that no compiler's plain calls are: what each computes and the clock behind it
// leave as text. Built with -msave-restore, whose helpers return by t0. Its test: images_test.cpp.
#include "firmware/boot/boot.hpp"
#include "firmware/examples/text.hpp"

namespace torolux::tests {
namespace {

// By the ABI's other link register, and by `ret` to where no call stands.
asm(R"(
  .section .text.jumps, "ax"
by_other_link:                 # a0 * 3, by a helper that t0 returns from
  mv   t1, a0
  jal  t0, twice
  add  a0, a0, t1
  ret
twice:
  slli a0, a0, 1
  jr   t0

by_own_link:                   # a0 + 40, by a function that is jumped to
  mv   t2, ra
  li   t3, 33                  # kept in a register that no call keeps
  la   ra, 1f
  j    add_seven
1:
  add  a0, a0, t3
  mv   ra, t2
  ret
add_seven:
  addi a0, a0, 7
  ret

to_a_label:                    # a0 = 0..3: jumps to the a0'th instruction of four; the rest of them run
  la   t0, 2f
  slli a0, a0, 2
  add  t0, t0, a0
  li   a0, 100
  jr   t0
  .option push
  .option norvc
2:
  addi a0, a0, 1
  addi a0, a0, 10
  addi a0, a0, 100
  addi a0, a0, 1000
  .option pop
  ret

switch_stack:                  # saves what a call keeps on the stack of a0, takes it from that of a1
  addi sp, sp, -64
  sw   ra, 0(sp)
  sw   s0, 4(sp)
  sw   s1, 8(sp)
  sw   s2, 12(sp)
  sw   s3, 16(sp)
  sw   s4, 20(sp)
  sw   s5, 24(sp)
  sw   s6, 28(sp)
  sw   s7, 32(sp)
  sw   s8, 36(sp)
  sw   s9, 40(sp)
  sw   s10, 44(sp)
  sw   s11, 48(sp)
  sw   sp, 0(a0)
  lw   sp, 0(a1)
  lw   ra, 0(sp)
  lw   s0, 4(sp)
  lw   s1, 8(sp)
  lw   s2, 12(sp)
  lw   s3, 16(sp)
  lw   s4, 20(sp)
  lw   s5, 24(sp)
  lw   s6, 28(sp)
  lw   s7, 32(sp)
  lw   s8, 36(sp)
  lw   s9, 40(sp)
  lw   s10, 44(sp)
  lw   s11, 48(sp)
  addi sp, sp, 64
  ret
  .text
)");
extern "C" {
std::uint32_t by_other_link(std::uint32_t);
std::uint32_t by_own_link(std::uint32_t);
std::uint32_t to_a_label(std::uint32_t);
void switch_stack(std::uint32_t* from, const std::uint32_t* to);
}

constexpr std::uint32_t kFrameWords = 16;  // of switch_stack
std::uint32_t main_stack = 0;
std::uint32_t coroutine_stack = 0;
alignas(16) std::uint32_t coroutine_words[256];
volatile std::uint32_t produced = 0;

/// Squares, one for each switch; the first switch enters it by `ret`.
[[noreturn]] void coroutine() {
  for (std::uint32_t n = 1;; ++n) {
    produced = n * n;
    switch_stack(&coroutine_stack, &main_stack);
  }
}

std::uint32_t sum_of_squares(std::uint32_t count) {
  std::uint32_t* frame = coroutine_words + 256 - kFrameWords;
  frame[0] = reinterpret_cast<std::uint32_t>(&coroutine);
  coroutine_stack = reinterpret_cast<std::uint32_t>(frame);
  std::uint32_t sum = 0;
  for (std::uint32_t n = 0; n < count; ++n) {
    switch_stack(&main_stack, &coroutine_stack);
    sum += produced;
  }
  return sum;
}

/// Needs many registers that calls keep: with -msave-restore helpers save and restore them.
// NOLINTNEXTLINE(misc-no-recursion): the way to many frames
[[gnu::noinline]] std::uint32_t paths(std::uint32_t right, std::uint32_t down, std::uint32_t step) {
  if (right == 0 || down == 0) return step;
  const std::uint32_t a = paths(right - 1, down, step);
  const std::uint32_t b = paths(right, down - 1, step);
  return a + b;
}

void say(pe::Niu& niu, const char* what, std::uint32_t value) {
  std::uint32_t cycle = 0;
  std::uint32_t instructions = 0;
  asm volatile("rdcycle %0" : "=r"(cycle));
  asm volatile("rdinstret %0" : "=r"(instructions));
  examples::Text line;
  line << what << " " << value << " at " << niu.clock() << ", " << cycle << ", " << instructions;
  line.send(niu);
}

}  // namespace
}  // namespace torolux::tests

void torolux::pe::pe_main(Niu& niu) {
  using namespace torolux::tests;
  using examples::Text;
  // More than the outgoing queue holds: counters are read behind HINTs that waited, too.
  for (std::uint32_t line = 0; line < 20; ++line) say(niu, "counters", line);
  say(niu, "other link", by_other_link(14));
  say(niu, "own link", by_own_link(2));
  std::uint32_t labels = 0;
  for (std::uint32_t n = 0; n < 4; ++n) labels += to_a_label(n);
  say(niu, "labels", labels);
  say(niu, "squares", sum_of_squares(10));
  say(niu, "paths", paths(5, 5, 1));
  Text numbers;
  numbers << "numbers " << -1 << " " << 2.5F << " " << -0.000001F << " " << 0.9999999F << " " << true << " " << 'x'
          << " " << (std::int64_t{1} << 40U) << " " << 7U;
  numbers.send(niu);
}
