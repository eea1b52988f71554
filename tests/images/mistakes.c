// SPDX-License-Identifier: MIT
// Mistakes that everybody makes once; the argument says which. Its test, with what each must say: mistakes_test.cpp.
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <torolux.h>

static volatile int sink;

static void out_of_memory(void) {
  char* volatile text = malloc((size_t)1 << 30U);
  text[0] = 'x';  // the mistake: nobody has looked at what malloc gave
  sink = text[0];
}

static void message_too_long(void) {
  torolux_send(0, "", TOROLUX_MOST_BYTES + 1);
}

static void no_room(void) {
  char four[4];
  torolux_send((int)torolux_pe(), "five!", 5);
  torolux_receive(TOROLUX_ANY, four, sizeof four);
}

static void no_such_pe(void) {
  torolux_send((int)torolux_pes(), "", 0);
}

static void both_receive_first(void) {
  const int other = (int)torolux_pe() ^ 1;
  int number;
  torolux_receive(other, &number, sizeof number);
  torolux_send(other, &number, sizeof number);
}

static unsigned too_deep(unsigned depth) {
  volatile char on_the_stack[512];
  on_the_stack[depth % sizeof on_the_stack] = 1;
  return depth == 1000000 ? 0 : too_deep(depth + 1) + (unsigned)on_the_stack[0];
}

static void never_ends(void) {
  while (sink == 0) {
  }
}

static void not_all_at_the_barrier(void) {
  if (torolux_pe() != 1) torolux_barrier();
}

static void false_assertion(void) {
  assert(torolux_pes() == 0);
}

static void store_into_a_constant(void) {
  char* const text = (char*)"constant";
  *(volatile char*)text = 'C';
}

static void file_that_nobody_named(void) {
  FILE* const file = fopen("data.txt", "r");
  if (file == NULL) torolux_fail("data.txt cannot be read");
  fclose(file);
}

static void nowhere_to_go(void) {
  void (*volatile nowhere)(void) = NULL;
  nowhere();
}

static void no_memory_for_what_waits(void) {
  static char message[64 * 1024];
  const int other = (int)torolux_pe() ^ 1;
  for (;;) torolux_send(other, message, sizeof message);  // nobody receives
}

static void different_sizes(void) {
  char data[8] = {0};
  torolux_broadcast(0, data, torolux_pe() == 0 ? 8 : 4);
}

int main(int argc, char** argv) {
  static const struct {
    const char* name;
    void (*make)(void);
  } mistakes[] = {
      {"out_of_memory", out_of_memory},
      {"message_too_long", message_too_long},
      {"no_room", no_room},
      {"no_such_pe", no_such_pe},
      {"both_receive_first", both_receive_first},
      {"never_ends", never_ends},
      {"not_all_at_the_barrier", not_all_at_the_barrier},
      {"false_assertion", false_assertion},
      {"store_into_a_constant", store_into_a_constant},
      {"file_that_nobody_named", file_that_nobody_named},
      {"nowhere_to_go", nowhere_to_go},
      {"no_memory_for_what_waits", no_memory_for_what_waits},
      {"different_sizes", different_sizes},
  };
  if (argc != 2) return 1;
  if (strcmp(argv[1], "too_deep") == 0) return (int)too_deep(0);
  for (size_t i = 0; i < sizeof mistakes / sizeof *mistakes; ++i) {
    if (strcmp(argv[1], mistakes[i].name) == 0) mistakes[i].make();
  }
  return 0;
}
