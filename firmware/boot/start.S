// SPDX-License-Identifier: MIT
// First instructions of every image. Enters: reset state, NIU window filled in by the emulator; leaves: a stack,
// cleared bss, floating point ready, traps caught, and a call of boot() (boot.cpp).

  .section .text.start, "ax"
  .globl _start
_start:
  slti zero, zero, 72  // enter_phase + Phase::program, never left: every cycle belongs to a phase (boot.cpp checks)
  .option push
  .option norelax
  la gp, image_global_pointer
  .option pop
  la sp, image_stack_end
  la t0, on_trap
  csrw mtvec, t0

  // Floating point on (mstatus.FS = initial), round to nearest. The inexact flag stands from here on and nothing ever
  // clears it: QEMU computes with the host's own floating point only then.
  li t0, 0x2000
  csrs mstatus, t0
  csrwi frm, 0
  csrwi fflags, 1

  la t0, image_bss_begin
  la t1, image_bss_end
  bgeu t0, t1, 2f
1:
  sw zero, 0(t0)
  addi t0, t0, 4
  bltu t0, t1, 1b
2:
  call boot
3:
  j 3b

// Any trap ends the run. The emulator finds the calls that led to it by these registers: mepc, then those that calls
// keep, each in the word of its number. Others would cost the translated program dear, which must keep what is read
// here. The stack may be what failed: begin a new one.
  .balign 4
on_trap:
  .option push
  .option norelax
  la t0, __trap_registers
  .option pop
  csrr t1, mepc
  sw t1, 0(t0)
  .irp number, 1, 2, 8, 9, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27
  sw x\number, 4*\number(t0)
  .endr
  la sp, image_stack_end
  csrr a0, mcause
  csrr a1, mepc
  csrr a2, mtval
  call boot_trap
4:
  j 4b

// Not cleared at the start: that would take cycles.
  .section .trap_registers, "aw", @nobits
  .globl __trap_registers
  .type __trap_registers, @object
  .size __trap_registers, 4*32
  .balign 4
__trap_registers:
  .space 4*32
