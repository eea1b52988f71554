// SPDX-License-Identifier: MIT
// A sum over a ring: a number goes once around all PEs, each adds its own, and the first prints what comes home.
#include <stdio.h>
#include <torolux.h>

int main(void) {
  const unsigned pe = torolux_pe();
  const unsigned pes = torolux_pes();
  const int next = (int)((pe + 1) % pes);
  const int previous = (int)((pe + pes - 1) % pes);
  const unsigned own = pe + 1;

  unsigned sum = 0;
  if (pe == 0) {
    torolux_send(next, &own, sizeof own);
    torolux_receive(previous, &sum, sizeof sum);
    printf("1 + 2 + ... + %u = %u, after %llu cycles\n", pes, sum, (unsigned long long)torolux_clock());
  } else {
    torolux_receive(previous, &sum, sizeof sum);
    sum += own;
    torolux_send(next, &sum, sizeof sum);
  }
  return 0;
}
