/* SPDX-License-Identifier: MIT */
/* An image in assembler alone, on the constants of torolux.h: sends a line to the host and halts. Links without the kit's
   start and libraries; with OWN_START_CALLS it calls `answer` and sends the number that it returns, one digit. */
#include <torolux.h>

/* A HINT, executed again while the NIU asks for it; a0: the NIU window. */
.macro HINT number
1:  slti zero, zero, \number
  lw t0, TOROLUX_WINDOW_RETRY(a0)
  bnez t0, 1b
.endm

  .section .text.start, "ax"
  .globl _start
_start:
  la sp, image_stack_end
  la s0, __niu_window
  mv a0, s0
  lw t0, TOROLUX_WINDOW_PROTOCOL_VERSION(a0)
  li t1, TOROLUX_PROTOCOL_VERSION
  bne t0, t1, wrong
#ifdef OWN_START_CALLS
  call answer
  la t0, line
  addi a0, a0, '0'
  sb a0, 8(t0)
#endif
  mv a0, s0
  li t0, TOROLUX_TO_HOST
  sh t0, TOROLUX_WINDOW_SEND_DESTINATION(a0)
  la t0, message
  sw t0, TOROLUX_WINDOW_SEND_ADDRESS(a0)
  HINT TOROLUX_HINT_SEND_MESSAGE
  HINT TOROLUX_HINT_HALT
2:  j 2b
wrong:
  HINT TOROLUX_HINT_FAIL
3:  j 3b

  .data
  .balign 8
message:
  .half TOROLUX_MESSAGE_TEXT, 0
  .word line_end - line
line:
  .ascii "answer: ?"
line_end:
