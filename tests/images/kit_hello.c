/* SPDX-License-Identifier: MIT
 * A program in C on the kit: PE number and arguments enter, a line and an exit status leave. */
#include <stdio.h>
#include <torolux.h>

int main(int argc, char** argv) {
  printf("Hello from PE %u of %u, %.3f, %llu, %d arguments, the last %s\n", torolux_pe(), torolux_pes(), 2.5,
         1ULL << 40, argc, argv[argc - 1]);
  return 0;
}
