/* SPDX-License-Identifier: MIT
 * Each PE tells its neighbour in the east a number and a float; nothing enters, a line of each PE leaves. */
#include <stdio.h>
#include <torolux.h>

int main(void) {
  struct {
    unsigned number;
    float value;
  } out = {torolux_pe() * 10, 1.0F / (float)(torolux_pe() + 3)}, in;
  const int west = (int)torolux_neighbour(TOROLUX_WEST);
  torolux_exchange((int)torolux_neighbour(TOROLUX_EAST), &out, sizeof out, west, &in, sizeof in);
  printf("from %u: %u %.5f\n", torolux_source(), in.number, (double)in.value);
  return 0;
}
