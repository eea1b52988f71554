// SPDX-License-Identifier: MIT
// The sum of a vector over all PEs, for all PEs, in two ways: around a ring, and by a tree. Arguments: `ring` or
// `tree`, how many numbers the vector has (at least one for each PE), and how often that is done (once). PE 0 prints
// the cycles of one time; every PE checks the first result.
//
// Ring: the vector is cut into a part for each PE. In P - 1 steps each part goes around and gathers what each PE adds;
// in P - 1 more the sums go around. Each PE sends 2 (P - 1) / P of a vector, whatever P is, but P times as many
// messages. Tree (torolux_all_reduce): few messages one after the other, but each is a whole vector.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <torolux.h>

TOROLUX_PHASE_NAME(0, "reduce");

// The ring goes forth in even rows and back in odd ones, so that all but the last step home are over a single link.
static unsigned place_in_ring(unsigned pe) {
  const unsigned columns = torolux_columns();
  const unsigned row = pe / columns;
  const unsigned column = pe % columns;
  return row * columns + (row % 2 == 0 ? column : columns - 1 - column);
}

// The snake is its own inverse: the same reversal of odd rows leads back.
static unsigned pe_in_ring(unsigned place) {
  return place_in_ring(place);
}

struct part {
  unsigned begin, count;  // numbers of the vector
};

static struct part part_of(unsigned number, unsigned parts, unsigned count) {
  const unsigned begin = (unsigned)((uint64_t)number * count / parts);
  const unsigned end = (unsigned)((uint64_t)(number + 1) * count / parts);
  return (struct part){begin, end - begin};
}

// Sends one part to the next PE of the ring, while another comes from the one before.
static void pass(const uint32_t* out, unsigned out_count, uint32_t* in, unsigned in_count) {
  const unsigned pes = torolux_pes();
  const unsigned place = place_in_ring(torolux_pe());
  const int next = (int)pe_in_ring((place + 1) % pes);
  const int previous = (int)pe_in_ring((place + pes - 1) % pes);
  torolux_exchange(next, out, out_count * sizeof *out, previous, in, in_count * sizeof *in);
}

static void ring_all_reduce(uint32_t* vector, unsigned count) {
  const unsigned pes = torolux_pes();
  const unsigned place = place_in_ring(torolux_pe());
  uint32_t* const coming = malloc((count / pes + 1) * sizeof *coming);
  if (coming == NULL) torolux_fail("no memory for a part of the vector");
  for (unsigned step = 0; step + 1 < pes; ++step) {
    const struct part out = part_of((place + pes - step) % pes, pes, count);
    const struct part in = part_of((place + 2 * pes - step - 1) % pes, pes, count);
    pass(vector + out.begin, out.count, coming, in.count);
    for (unsigned i = 0; i < in.count; ++i) vector[in.begin + i] += coming[i];
  }
  free(coming);
  for (unsigned step = 0; step + 1 < pes; ++step) {
    const struct part out = part_of((place + 1 + pes - step) % pes, pes, count);
    const struct part in = part_of((place + pes - step) % pes, pes, count);
    pass(vector + out.begin, out.count, vector + in.begin, in.count);
  }
}

// PE `pe` adds (pe + 1) * kOfPe + i * kOfNumber to number i.
static const uint32_t kOfPe = 2654435761U;
static const uint32_t kOfNumber = 40503U;

static void fill(uint32_t* vector, unsigned count) {
  uint32_t addend = (torolux_pe() + 1) * kOfPe;
  for (unsigned i = 0; i < count; ++i, addend += kOfNumber) vector[i] = addend;
}

static void check(const uint32_t* vector, unsigned count) {
  const uint32_t pes = torolux_pes();
  uint32_t sum = 0;
  for (unsigned pe = 0; pe < pes; ++pe) sum += (pe + 1) * kOfPe;
  for (unsigned i = 0; i < count; ++i, sum += pes * kOfNumber) {
    if (vector[i] != sum) torolux_fail("a sum is wrong");
  }
}

static void all_reduce(int by_ring, uint32_t* vector, unsigned count) {
  TOROLUX_ENTER_PHASE(0);
  if (by_ring) {
    ring_all_reduce(vector, count);
  } else {
    torolux_all_reduce(vector, count, TOROLUX_UINT32, TOROLUX_SUM);
  }
  TOROLUX_LEAVE_PHASE(0);
}

int main(int argc, char** argv) {
  const int given = argc == 3 || argc == 4;
  const unsigned count = given ? (unsigned)strtoul(argv[2], NULL, 10) : 0;
  const unsigned times = argc == 4 ? (unsigned)strtoul(argv[3], NULL, 10) : 1;
  const int by_ring = given && strcmp(argv[1], "ring") == 0;
  const int by_tree = given && strcmp(argv[1], "tree") == 0;
  if (count < torolux_pes() || times == 0 || (!by_ring && !by_tree)) {
    if (torolux_pe() == 0) fprintf(stderr, "arguments: ring|tree NUMBERS [TIMES], at least %u numbers\n", torolux_pes());
    return 1;
  }
  uint32_t* const vector = malloc(count * sizeof *vector);
  if (vector == NULL) torolux_fail("no memory for the vector: give the PEs more (--pe-memory)");
  fill(vector, count);

  torolux_barrier();
  uint64_t cycles = 0;
  for (unsigned time = 0; time < times; ++time) {
    const uint64_t begin = torolux_clock();
    all_reduce(by_ring, vector, count);
    torolux_barrier();
    cycles += torolux_clock() - begin;
    if (time == 0) check(vector, count);
  }
  if (torolux_pe() == 0) {
    printf("%s: %u numbers, %llu cycles\n", argv[1], count, (unsigned long long)(cycles / times));
  }
  return 0;
}
