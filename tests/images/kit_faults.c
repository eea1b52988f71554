/* SPDX-License-Identifier: MIT
 * Wrong uses of the kit: the argument says which; each ends the run with a message. */
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <torolux.h>

TOROLUX_PHASE_NAME(3, "shift");

static char buffer[2048];

static void too_long_for_receiver(void) {
  if (torolux_pe() == 0) torolux_send(1, buffer, 200);
  if (torolux_pe() == 1) torolux_receive(0, buffer, 100); /* no room */
}

static void no_memory_for_messages(void) {
  if (torolux_pe() == 0) {
    for (int i = 0; i < 2000; ++i) torolux_send(1, buffer, sizeof buffer);
  } else {
    torolux_receive(1, buffer, 1);
  }
}

/* Each PE makes one call of its own: which of them its root, type and operation belong to is for the others to see. */
static void disagree(const char* what) {
  const int first = torolux_pe() == 0;
  const enum torolux_type type = strcmp(what, "type") == 0 && !first ? TOROLUX_INT64 : TOROLUX_DOUBLE;
  const enum torolux_operation operation = strcmp(what, "operation") == 0 && !first ? TOROLUX_MAXIMUM : TOROLUX_SUM;
  if (strcmp(what, "kind") == 0 && first) torolux_broadcast(0, buffer, 8);
  if (strcmp(what, "kind") == 0 && !first) torolux_reduce(1, buffer, 1, TOROLUX_FLOAT, TOROLUX_SUM);
  if (strcmp(what, "roots") == 0) torolux_broadcast(torolux_pe(), buffer, 8);
  if (strcmp(what, "type") == 0 || strcmp(what, "operation") == 0) torolux_all_reduce(buffer, 1, type, operation);
  if (strcmp(what, "more") == 0) torolux_reduce(0, buffer, first ? 252 : 253, TOROLUX_INT32, TOROLUX_SUM);
  if (strcmp(what, "again") == 0 && !first) torolux_broadcast(1, buffer, 8);
  if (strcmp(what, "again") == 0) torolux_broadcast(0, buffer, 8);
  if (strcmp(what, "without") == 0 && first) torolux_broadcast(0, buffer, 8);
  /* What the other has sent has come by now: who ends notices it. */
  for (volatile int i = 0; i < 2000; ++i) continue;
}

static int deep(int depth) {
  volatile char frame[1024];
  frame[depth % 1024] = (char)depth;
  return depth == 0 ? 0 : deep(depth - 1) + frame[depth % 1024];
}

int main(int argc, char** argv) {
  const char* what = argc > 1 ? argv[1] : "";
  if (argc > 2) disagree(argv[2]);
  if (strcmp(what, "heap") == 0) {
    while (strdup("what the C library takes for itself")) continue;
  }
  if (strcmp(what, "pe") == 0) torolux_send(70, buffer, 1);
  if (strcmp(what, "negative") == 0) torolux_receive(-5, buffer, 1);
  if (strcmp(what, "bytes") == 0) torolux_send(0, buffer, TOROLUX_MOST_BYTES + 1);
  if (strcmp(what, "room") == 0) too_long_for_receiver();
  if (strcmp(what, "memory") == 0) no_memory_for_messages();
  if (strcmp(what, "deadlock") == 0) torolux_receive(TOROLUX_ANY, buffer, 1);
  if (strcmp(what, "stack") == 0) return deep(100000);
  if (strcmp(what, "assert") == 0) assert(argc == 7);
  if (strcmp(what, "abort") == 0) abort();
  if (strcmp(what, "fail") == 0) torolux_fail("the sort is wrong");
  if (strcmp(what, "host") == 0) torolux_send(TOROLUX_HOST, buffer, 3);
  if (strcmp(what, "overlap") == 0) torolux_exchange(0, buffer, 100, 0, buffer + 50, 100);
  if (strcmp(what, "broadcast") == 0) torolux_broadcast(0, buffer, torolux_pe() == 0 ? 100 : 50);
  if (strcmp(what, "root") == 0) torolux_reduce(9, buffer, 1, TOROLUX_FLOAT, TOROLUX_SUM);
  if (strcmp(what, "phase") == 0) TOROLUX_LEAVE_PHASE(3);
  if (strcmp(what, "exit") == 0) exit(torolux_pe() == 1 ? 258 : 0);
  return 0;
}
