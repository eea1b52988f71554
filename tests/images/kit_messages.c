/* SPDX-License-Identifier: MIT
 * Messages of the kit on any torus: what each PE has got is checked against what was sent; one line says how many
 * checks held. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <torolux.h>

enum { ROOM = 102400 + 64, SMALL = 300, FLOOD = 40 };

static unsigned checks;

static void check(int holds, const char* what) {
  if (!holds) torolux_fail(what);
  ++checks;
}

static unsigned char byte_of(unsigned pe, size_t at) {
  return (unsigned char)(at * 7 + at / 251 + pe * 31);
}

static void fill(unsigned char* data, size_t bytes, unsigned pe) {
  for (size_t at = 0; at < bytes; ++at) data[at] = byte_of(pe, at);
}

static int holds(const unsigned char* data, size_t bytes, unsigned pe) {
  for (size_t at = 0; at < bytes; ++at) {
    if (data[at] != byte_of(pe, at)) return 0;
  }
  return 1;
}

/* All around the ring of PEs, of sizes near those of records and packets, from and to places of any alignment. */
static void shifts(unsigned char* out, unsigned char* in) {
  const size_t sizes[] = {0, 1, 47, 48, 49, 112, 113, 1007, 1008, 1009, 102400};
  const unsigned pe = torolux_pe(), pes = torolux_pes();
  const unsigned to = (pe + 1) % pes, from = (pe + pes - 1) % pes;
  for (unsigned i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
    for (unsigned offset = 0; offset < 60; offset += 13) {
      fill(out + offset, sizes[i], pe);
      memset(in, 0, ROOM);
      const size_t bytes = torolux_exchange((int)to, out + offset, sizes[i], (int)from, in + offset % 8, sizes[i]);
      check(bytes == sizes[i] && torolux_source() == from, "exchange: bytes or source");
      check(holds(in + offset % 8, bytes, from) && in[offset % 8 + bytes] == 0, "exchange: contents");
      torolux_send((int)to, out + offset, sizes[i]);
      check(torolux_receive((int)from, in, ROOM) == sizes[i] && holds(in, sizes[i], from), "send and receive");
    }
  }
}

/* Everybody sends everybody small messages before anybody receives; then from each in turn, in the order sent. */
static void flood(unsigned char* out, unsigned char* in) {
  const unsigned pe = torolux_pe(), pes = torolux_pes();
  for (unsigned round = 0; round < FLOOD; ++round) {
    for (unsigned to = 0; to < pes; ++to) {
      const size_t bytes = (pe * 5 + to * 3 + round * 17) % SMALL + 4;
      fill(out, bytes, pe + round);
      memcpy(out, &round, sizeof round);
      torolux_send((int)to, out, bytes);
    }
  }
  for (unsigned from = pes; from-- > 0;) {
    for (unsigned round = 0; round < FLOOD; ++round) {
      const size_t expected = (from * 5 + pe * 3 + round * 17) % SMALL + 4;
      check(torolux_receive((int)from, in, SMALL + 4) == expected, "flood: bytes");
      check(memcmp(in, &round, sizeof round) == 0, "flood: order");
      memcpy(out, in, sizeof round);
      fill(in, sizeof round, from + round);
      check(holds(in, expected, from + round), "flood: contents");
    }
  }
  check(torolux_waiting(TOROLUX_ANY) == -1, "flood: something is left");
}

/* PE 0 is busy while all others send it more than its NIU has slots for, on a large torus. */
static void late(unsigned char* out, unsigned char* in) {
  enum { EACH = 5, BYTES = 1000 };
  const unsigned pe = torolux_pe(), pes = torolux_pes();
  if (pe == 0) {
    for (volatile int i = 0; i < 50000; ++i) continue;
    for (unsigned from = pes; from-- > 1;) {
      for (unsigned i = 0; i < EACH; ++i) {
        check(torolux_receive((int)from, in, BYTES) == BYTES - i && holds(in, BYTES - i, from + i), "late: contents");
      }
    }
  } else {
    for (unsigned i = 0; i < EACH; ++i) {
      fill(out, BYTES - i, pe + i);
      torolux_send(0, out, BYTES - i);
    }
  }
}

/* From whomever: as many from each as were sent. */
static void any(unsigned char* in) {
  const unsigned pe = torolux_pe(), pes = torolux_pes();
  for (unsigned to = 0; to < pes; ++to) torolux_send((int)to, &pe, sizeof pe);
  unsigned* const seen = calloc(pes, sizeof *seen);
  for (unsigned i = 0; i < pes; ++i) {
    check(torolux_receive(TOROLUX_ANY, in, sizeof pe) == sizeof pe, "any: bytes");
    unsigned from;
    memcpy(&from, in, sizeof from);
    check(from == torolux_source() && seen[from]++ == 0, "any: source");
  }
  free(seen);
  while (torolux_waiting((int)pe) != -1) check(0, "any: more than were sent");
  torolux_send((int)pe, "abc", 3);
  check(torolux_waiting(TOROLUX_ANY) == 3 && torolux_receive((int)pe, in, 3) == 3, "any: to itself");
}

/* Against a plain computation; floats joined in the order that torolux.h promises repeat in every bit. */
static void together(void) {
  const unsigned pe = torolux_pe(), pes = torolux_pes();
  for (unsigned root = 0; root < pes; root += 3) {
    int32_t values[600];
    for (int i = 0; i < 600; ++i) values[i] = (int32_t)(pe + 1) * (i - 300);
    torolux_reduce(root, values, 600, TOROLUX_INT32, TOROLUX_SUM);
    for (int i = 0; i < 600 && pe == root; ++i) {
      check(values[i] == (int32_t)(pes * (pes + 1) / 2) * (i - 300), "reduce");
    }
    double largest[3] = {pe, -(double)pe, 7.5};
    torolux_all_reduce(largest, 3, TOROLUX_DOUBLE, TOROLUX_MAXIMUM);
    check(largest[0] == pes - 1 && largest[1] == 0 && largest[2] == 7.5, "all_reduce: maximum");
    unsigned char anywhere[2 * sizeof(uint32_t) + 1]; /* values that are not aligned */
    for (uint32_t i = 0; i < 2; ++i) memcpy(anywhere + 1 + i * sizeof i, &(uint32_t){(pe + 1) * (i + 70000)}, sizeof i);
    torolux_reduce(root, anywhere + 1, 2, TOROLUX_UINT32, TOROLUX_SUM);
    for (uint32_t i = 0, got = 0; i < 2 && pe == root; ++i) {
      memcpy(&got, anywhere + 1 + i * sizeof i, sizeof i);
      check(got == pes * (pes + 1) / 2 * (i + 70000), "reduce: not aligned");
    }
    unsigned char message[6000];
    for (unsigned bytes = 0; bytes <= sizeof message; bytes += 1500) {
      fill(message, bytes, pe);
      torolux_broadcast(root, message, bytes);
      check(holds(message, bytes, root), "broadcast");
    }
  }
  float sum = 1.0F / (float)(pe + 1);
  torolux_all_reduce(&sum, 1, TOROLUX_FLOAT, TOROLUX_SUM);
  uint64_t bits = 0;
  memcpy(&bits, &sum, sizeof sum);
  uint64_t all = bits;
  torolux_all_reduce(&all, 1, TOROLUX_UINT64, TOROLUX_MINIMUM);
  check(all == bits, "all_reduce: the same on each PE");
}

/* Nobody leaves before all have come. */
static void barriers(void) {
  for (unsigned late = 0; late < torolux_pes(); late += 5) {
    uint64_t came = 0;
    if (torolux_pe() == late) {
      for (volatile int i = 0; i < 20000; ++i) continue;
      came = torolux_clock();
    }
    torolux_barrier();
    const uint64_t left = torolux_clock();
    torolux_all_reduce(&came, 1, TOROLUX_UINT64, TOROLUX_MAXIMUM);
    check(left > came, "barrier");
  }
}

int main(void) {
  unsigned char* const out = malloc(ROOM);
  unsigned char* const in = malloc(ROOM);
  check(out != NULL && in != NULL, "memory");
  check(torolux_pe_at(-1, -1) == torolux_pes() - 1 &&
            torolux_pe_at((int)torolux_column(), (int)torolux_row()) == torolux_pe(),
        "place");
  shifts(out, in);
  torolux_barrier();
  flood(out, in);
  torolux_barrier();
  late(out, in);
  any(in);
  together();
  barriers();
  uint32_t sum = checks;
  torolux_reduce(0, &sum, 1, TOROLUX_UINT32, TOROLUX_SUM);
  if (torolux_pe() == 0) printf("%lu checks held\n", (unsigned long)sum);
  return 0;
}
