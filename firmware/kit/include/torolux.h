/* SPDX-License-Identifier: MIT
 * Torolux for programs in C: one PE's view of the torus. Each PE runs the whole program, from main, in its own memory;
 * what PEs know of each other travels as messages. Compile with `torolux cc`, run with `torolux run`.
 *
 * From C, C++ and, for the constants at the end, assembler. Every wrong use ends the run with a message that says what
 * and where; no function returns an error. Nothing here depends on the computer that emulates the machine.
 */
#ifndef TOROLUX_H
#define TOROLUX_H

#ifndef __ASSEMBLER__

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Where am I ---- */

/** This PE's number, 0 to torolux_pes() - 1. PEs are numbered row by row: row * columns + column. */
unsigned torolux_pe(void);
/** PEs of the torus: columns * rows. */
unsigned torolux_pes(void);
/** Columns of the torus, 1 or more. */
unsigned torolux_columns(void);
/** Rows of the torus, 1 or more. */
unsigned torolux_rows(void);
/** This PE's column, 0 to torolux_columns() - 1. */
unsigned torolux_column(void);
/** This PE's row, 0 to torolux_rows() - 1. */
unsigned torolux_row(void);
/** The PE at this place. Any whole numbers: the torus is closed in both directions. */
unsigned torolux_pe_at(int column, int row);

/** The four links of a PE: east raises the column, south raises the row. */
enum torolux_link { TOROLUX_EAST, TOROLUX_WEST, TOROLUX_SOUTH, TOROLUX_NORTH };
/** The PE at the other end of one of this PE's links; in a torus of one column or row this PE itself. */
unsigned torolux_neighbour(enum torolux_link link);

/** Bytes of this PE's local memory (`torolux run --pe-memory`). */
size_t torolux_memory_bytes(void);

/* ---- Messages ---- */

/** The most bytes of one message. */
#define TOROLUX_MOST_BYTES 1048576
/** To torolux_receive: from whomever. */
#define TOROLUX_ANY (-1)
/** To torolux_send: the host, which appends the bytes to the file that `--output host=FILE` names. */
#define TOROLUX_HOST (-2)

/** Sends `bytes` (0 to TOROLUX_MOST_BYTES) from `data` to a PE, this one too. They are copied: `data` is free again
 * afterwards. Waits only while the NIU's outgoing queue is full, never for the receiver. What one PE sends another
 * arrives in that order. Ends the run: no such PE, too many bytes. */
void torolux_send(int pe, const void* data, size_t bytes);

/** Waits for the next message from `pe`, or TOROLUX_ANY: of those that are here, the one that came first. Writes it to
 * `data`, which has room for `room` bytes, and returns how many bytes it had. Messages from others wait meanwhile, in
 * the memory that malloc also uses. Ends the run: no such PE, no room for the message, no memory for those that wait.
 */
size_t torolux_receive(int pe, void* data, size_t room);

/** Whether torolux_receive(pe, ...) would return at once: the bytes of the next message, or -1 where none is here. */
long torolux_waiting(int pe);

/** Who sent the last message that torolux_receive or torolux_exchange has brought. */
unsigned torolux_source(void);

/** Sends and receives at once, as torolux_send(to, ...) and then torolux_receive(from, ...) would, but what comes in
 * goes straight to its place while the rest goes out. For shifts and halos. */
size_t torolux_exchange(int to, const void* data, size_t bytes, int from, void* in, size_t room);

/* ---- All PEs together: every PE must call these, in the same order ---- */

/** Returns when all PEs have called it. Of all in this section: PEs that call another one, or of another root, type,
 * operation or size, end the run with both calls: where one waits for the other, there; else where a PE ends by exit(0)
 * or main's return, if the whole of what the other has sent is here by then. */
void torolux_barrier(void);

/** `bytes` (0 to TOROLUX_MOST_BYTES) at `data` of PE `root` come to `data` of all others. The same `bytes` on each. */
void torolux_broadcast(unsigned root, void* data, size_t bytes);

/** What torolux_reduce works on. */
enum torolux_type { TOROLUX_INT32, TOROLUX_UINT32, TOROLUX_INT64, TOROLUX_UINT64, TOROLUX_FLOAT, TOROLUX_DOUBLE };
/** How torolux_reduce joins two values. */
enum torolux_operation { TOROLUX_SUM, TOROLUX_MINIMUM, TOROLUX_MAXIMUM };

/** Value by value over all PEs, `count` of them at `data` of each (at most TOROLUX_MOST_BYTES in all): the result is in
 * `data` of PE `root`; elsewhere `data` is overwritten. The order in which values are joined depends on the number of
 * PEs alone, so sums of floats repeat exactly. */
void torolux_reduce(unsigned root, void* data, size_t count, enum torolux_type type, enum torolux_operation operation);

/** As torolux_reduce, with the result in `data` of every PE. */
void torolux_all_reduce(void* data, size_t count, enum torolux_type type, enum torolux_operation operation);

/* ---- Time ---- */

/** The PE's clock in cycles since its start: instructions by their latency, and the time spent waiting. */
uint64_t torolux_clock(void);
/** Instructions that this PE has executed. */
uint64_t torolux_instructions(void);

/** Phases of a program: what it spends its cycles on, in statistics, report and trace. At file scope, once for each
 * number 0 to TOROLUX_PHASES - 1; name: up to 23 characters: TOROLUX_PHASE_NAME(0, "multiply"); */
#define TOROLUX_PHASES 7
#define TOROLUX_PHASE_NAME(number, text)                                  \
  __attribute__((section(".torolux.phases"), used)) static const struct { \
    uint32_t phase;                                                       \
    char name[24];                                                        \
  } torolux_phase_name_##number = {TOROLUX_FIRST_PHASE + (number), text}
/** Cycles from here on belong to this phase (a constant), until it is left. Phases may nest. Costs no cycles. */
#define TOROLUX_ENTER_PHASE(number) TOROLUX_MARK_(TOROLUX_HINT_ENTER_PHASE + TOROLUX_FIRST_PHASE + (number))
/** Ends the innermost phase, which must be this one. */
#define TOROLUX_LEAVE_PHASE(number) TOROLUX_MARK_(TOROLUX_HINT_LEAVE_PHASE + TOROLUX_FIRST_PHASE + (number))
#define TOROLUX_MARK_(immediate) __asm__ volatile(".insn i 0x13, 2, x0, x0, %0" : : "i"(immediate) : "memory")

/* ---- The end ---- */

/** Ends the run of all PEs, with exit code 3, this PE's number, where it was called, and `why`. To end well: return
 * from main, or exit(0). exit(n) ends this PE alone; the first n that is not 0 becomes the exit code of the run. */
void torolux_fail(const char* why) __attribute__((noreturn));

#ifdef __cplusplus
}
#endif

#endif /* not assembler */

/* ---- For assembler, and for drivers of one's own ---- */

/** Of the NIU window: a start of one's own compares it with what stands at TOROLUX_WINDOW_PROTOCOL_VERSION. */
#define TOROLUX_PROTOCOL_VERSION 23

/** HINTs are the 4-byte instruction `slti x0, x0, number`, executed again while the word at TOROLUX_WINDOW_RETRY is not
 * 0. Their arguments and results lie in the NIU window; which, Hint (firmware/protocol/hints.hpp) says. */
#define TOROLUX_HINT_SEND_RECORDS 1
#define TOROLUX_HINT_SEND_MESSAGE 2
#define TOROLUX_HINT_RECEIVE 3
#define TOROLUX_HINT_RECEIVE_IF_ANY 4
#define TOROLUX_HINT_CLOCK 5
#define TOROLUX_HINT_SET_SLOTS 6
#define TOROLUX_HINT_HALT 7
#define TOROLUX_HINT_FAIL 8
#define TOROLUX_HINT_RECEIVE_MORE 9
#define TOROLUX_HINT_RECEIVE_DUE 10

/** Markers of phases, never repeated: the sum of one of these and the phase. Those of TOROLUX_ENTER_PHASE begin at
 * TOROLUX_FIRST_PHASE. */
#define TOROLUX_HINT_ENTER_PHASE 64
#define TOROLUX_HINT_LEAVE_PHASE 128
#define TOROLUX_FIRST_PHASE 9

/** The NIU window's fields, in bytes from the symbol `__niu_window`, as NiuWindow (firmware/protocol/niu_window.hpp)
 * describes them. Set before the start: */
#define TOROLUX_WINDOW_PROTOCOL_VERSION 0
#define TOROLUX_WINDOW_PE 4
#define TOROLUX_WINDOW_COLUMNS 8
#define TOROLUX_WINDOW_ROWS 12
#define TOROLUX_WINDOW_MEMORY_BYTES 16

/** Set by the NIU: of 4 bytes, of 8, of 4, of 2, of 2 and of 2 each. */
#define TOROLUX_WINDOW_RETRY 20
#define TOROLUX_WINDOW_CLOCK 24
#define TOROLUX_WINDOW_ARRIVAL_KIND 32
#define TOROLUX_WINDOW_ARRIVAL_SOURCE 36
#define TOROLUX_WINDOW_ARRIVAL_COUNT 38
#define TOROLUX_WINDOW_ARRIVAL_SLOTS 40

/** Where the record slots are, for TOROLUX_HINT_SET_SLOTS: of 4 bytes each. */
#define TOROLUX_WINDOW_SLOTS_ADDRESS 72
#define TOROLUX_WINDOW_SLOTS_BYTES 76
#define TOROLUX_WINDOW_SLOTS_OWN 80
#define TOROLUX_WINDOW_SLOTS_NIU 84

/** What is sent: of 2 bytes, of 2, of 4, and of 2 each. */
#define TOROLUX_WINDOW_SEND_DESTINATION 88
#define TOROLUX_WINDOW_SEND_COUNT 90
#define TOROLUX_WINDOW_SEND_ADDRESS 92
#define TOROLUX_WINDOW_SEND_SLOTS 96

/** How long records gather: of 4 bytes each. */
#define TOROLUX_WINDOW_GATHER_CYCLES 128
#define TOROLUX_WINDOW_GATHER_RECORDS 132

/** Slots that are given back: how many (4 bytes), and which (2 bytes each, up to 64). */
#define TOROLUX_WINDOW_RELEASED 136
#define TOROLUX_WINDOW_RELEASE 140

/** Why TOROLUX_HINT_FAIL ends the run: of 4 bytes, and three of 4 bytes. */
#define TOROLUX_WINDOW_FAULT_CODE 268
#define TOROLUX_WINDOW_FAULT_DETAIL 272

/** The last message that came: of 2 bytes, of 2, of 4, and its bytes. */
#define TOROLUX_WINDOW_MESSAGE_KIND 288
#define TOROLUX_WINDOW_MESSAGE_SOURCE 290
#define TOROLUX_WINDOW_MESSAGE_BYTES 292
#define TOROLUX_WINDOW_MESSAGE 296

/** Destinations beside the PEs; and the kind of a message to the host that `torolux run` prints. */
#define TOROLUX_TO_HOST 0xFFF1
#define TOROLUX_TO_FRAME_BUFFER 0xFFF2
#define TOROLUX_MESSAGE_TEXT 1

#endif /* TOROLUX_H */
