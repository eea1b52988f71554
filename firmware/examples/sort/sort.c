// SPDX-License-Identifier: MIT
// Numbers that lie on all PEs are sorted over all of them: afterwards each PE's are in order, and none is greater than
// any of the next PE's. Arguments: how many numbers in all, and `check` to have the result checked. PE 0 prints the
// cycles, and how evenly they lie.
//
// By samples (Shi and Schaeffer 1992): each PE sorts its own and tells some that lie evenly in them; from the samples
// of all come the borders between PEs; each PE sends each other one what lies between that one's borders, and merges
// what came.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <torolux.h>

TOROLUX_PHASE_NAME(0, "sort");
TOROLUX_PHASE_NAME(1, "borders");
TOROLUX_PHASE_NAME(2, "exchange");
TOROLUX_PHASE_NAME(3, "merge");

enum { kSamples = 16 };  // of each PE

struct numbers {
  uint32_t* number;
  size_t count;
};

static void* memory_for(size_t bytes) {
  void* const memory = malloc(bytes == 0 ? 1 : bytes);
  if (memory == NULL) torolux_fail("no memory: give the PEs more (--pe-memory), or sort fewer numbers");
  return memory;
}

static int compare(const void* a, const void* b) {
  const uint32_t x = *(const uint32_t*)a;
  const uint32_t y = *(const uint32_t*)b;
  return (x > y) - (x < y);
}

static void sort(struct numbers numbers) {
  qsort(numbers.number, numbers.count, sizeof *numbers.number, compare);
}

// Two parts that are in order, one behind the other, become one.
static void merge_two(const uint32_t* a, const uint32_t* a_end, const uint32_t* b_end, uint32_t* out) {
  const uint32_t* b = a_end;
  while (a != a_end && b != b_end) *out++ = *b < *a ? *b++ : *a++;
  while (a != a_end) *out++ = *a++;
  while (b != b_end) *out++ = *b++;
}

// Parts that are in order become one, two by two: in log2 of their number times over all numbers.
static struct numbers merge(struct numbers parts, size_t* begin, unsigned count) {
  uint32_t* spare = memory_for(parts.count * sizeof *spare);
  for (; count > 1; count = (count + 1) / 2) {
    for (unsigned part = 0; part < count; part += 2) {
      const size_t end = begin[part + 2 < count ? part + 2 : count];
      const uint32_t* const middle = parts.number + (part + 1 < count ? begin[part + 1] : end);
      merge_two(parts.number + begin[part], middle, parts.number + end, spare + begin[part]);
      begin[part / 2] = begin[part];
    }
    begin[(count + 1) / 2] = parts.count;
    uint32_t* const merged = spare;
    spare = parts.number;
    parts.number = merged;
  }
  free(spare);
  return parts;
}

// A hash (the finaliser of MurmurHash3): the numbers are the same on any torus.
static uint32_t hash(uint32_t x) {
  x = (x ^ (x >> 16)) * 0x85EBCA6BU;
  x = (x ^ (x >> 13)) * 0xC2B2AE35U;
  return x ^ (x >> 16);
}

// Each PE's equal part of `all` numbers.
static struct numbers make_numbers(size_t all) {
  const size_t begin = (size_t)((uint64_t)all * torolux_pe() / torolux_pes());
  const size_t end = (size_t)((uint64_t)all * (torolux_pe() + 1) / torolux_pes());
  struct numbers made = {memory_for((end - begin) * sizeof(uint32_t)), end - begin};
  for (size_t i = 0; i < made.count; ++i) made.number[i] = hash((uint32_t)(begin + i));
  return made;
}

// A PE's sample `i`: at another place on each PE, so that together they lie evenly where all PEs have alike numbers.
// Were the places the same, the samples would stand in kSamples heaps, with most numbers between heaps.
static uint32_t sample(struct numbers own, size_t i) {
  if (own.count == 0) return UINT32_MAX;
  const uint64_t places = 2 * kSamples * torolux_pes();
  return own.number[own.count * (2 * (i * torolux_pes() + torolux_pe()) + 1) / places];
}

// The first number of each PE but 0, found by PE 0 and told to all.
static void find_borders(struct numbers own, uint32_t* borders) {
  const unsigned pes = torolux_pes();
  uint32_t samples[kSamples];
  for (size_t i = 0; i < kSamples; ++i) samples[i] = sample(own, i);
  if (torolux_pe() == 0) {
    struct numbers all = {memory_for(pes * sizeof samples), (size_t)pes * kSamples};
    memcpy(all.number, samples, sizeof samples);
    size_t* const begin = memory_for((pes + 1) * sizeof *begin);
    for (unsigned pe = 1; pe < pes; ++pe) torolux_receive((int)pe, all.number + pe * kSamples, sizeof samples);
    for (unsigned pe = 0; pe <= pes; ++pe) begin[pe] = pe * kSamples;
    all = merge(all, begin, pes);
    for (unsigned pe = 1; pe < pes; ++pe) borders[pe - 1] = all.number[pe * kSamples];
    free(begin);
    free(all.number);
  } else {
    torolux_send(0, samples, sizeof samples);
  }
  torolux_broadcast(0, borders, (pes - 1) * sizeof *borders);
}

// The number of each PE's part in the sorted numbers where it begins; one more: the end.
static size_t* cut_at(struct numbers own, const uint32_t* borders) {
  const unsigned pes = torolux_pes();
  size_t* const first = memory_for((pes + 1) * sizeof *first);
  first[0] = 0;
  first[pes] = own.count;
  for (unsigned pe = 1; pe < pes; ++pe) {
    size_t at = first[pe - 1];
    while (at < own.count && own.number[at] < borders[pe - 1]) ++at;
    first[pe] = at;
  }
  return first;
}

// Sends each PE its part of the sorted numbers; returns what has come from all, one part behind the other. In step s
// everybody sends to the PE that is s further on, so that nobody is flooded. begin: of each part, and the end.
static struct numbers exchange(struct numbers own, const uint32_t* borders, size_t* begin) {
  const unsigned pes = torolux_pes();
  const unsigned pe = torolux_pe();
  size_t* const first = cut_at(own, borders);
  const size_t most = own.count + 1;  // from one PE: none had more than one more than another
  struct numbers come = {NULL, 0};
  size_t room = 0;
  for (unsigned step = 0; step < pes; ++step) {
    const unsigned to = (pe + step) % pes;
    const int from = (int)((pe + pes - step) % pes);
    torolux_send((int)to, own.number + first[to], (first[to + 1] - first[to]) * sizeof *own.number);
    if (room < come.count + most) {
      room = 2 * (come.count + most);
      come.number = realloc(come.number, room * sizeof *come.number);
      if (come.number == NULL) torolux_fail("no memory for the numbers that come: give the PEs more (--pe-memory)");
    }
    begin[step] = come.count;
    come.count += torolux_receive(from, come.number + come.count, most * sizeof *come.number) / sizeof *come.number;
  }
  begin[pes] = come.count;
  free(first);
  return come;
}

// In order here, and from PE to PE; none lost: their number and their sum are those of the beginning.
static void check(struct numbers sorted, struct numbers before) {
  for (size_t i = 1; i < sorted.count; ++i) {
    if (sorted.number[i - 1] > sorted.number[i]) torolux_fail("two numbers are out of order");
  }
  uint32_t greatest = sorted.count == 0 ? 0 : sorted.number[sorted.count - 1];
  if (torolux_pe() != 0) {
    uint32_t below = 0;
    torolux_receive((int)torolux_pe() - 1, &below, sizeof below);
    if (sorted.count != 0 && below > sorted.number[0]) torolux_fail("the PE before has a greater number");
    if (below > greatest) greatest = below;
  }
  if (torolux_pe() + 1 != torolux_pes()) torolux_send((int)torolux_pe() + 1, &greatest, sizeof greatest);

  uint64_t lost[2] = {(uint64_t)before.count - sorted.count, 0};
  for (size_t i = 0; i < before.count; ++i) lost[1] += before.number[i];
  for (size_t i = 0; i < sorted.count; ++i) lost[1] -= sorted.number[i];
  torolux_all_reduce(lost, 2, TOROLUX_UINT64, TOROLUX_SUM);
  if (lost[0] != 0 || lost[1] != 0) torolux_fail("numbers were lost");
}

int main(int argc, char** argv) {
  const size_t all = argc == 2 || argc == 3 ? strtoul(argv[1], NULL, 10) : 0;
  const int checked = argc == 3 && strcmp(argv[2], "check") == 0;
  if (all == 0 || (argc == 3 && !checked)) {
    if (torolux_pe() == 0) fprintf(stderr, "arguments: NUMBERS [check]\n");
    return 1;
  }
  struct numbers own = make_numbers(all);
  uint32_t* const borders = memory_for(torolux_pes() * sizeof *borders);
  size_t* const parts = memory_for((torolux_pes() + 1) * sizeof *parts);

  torolux_barrier();
  const uint64_t begin = torolux_clock();
  TOROLUX_ENTER_PHASE(0);
  sort(own);
  TOROLUX_LEAVE_PHASE(0);
  TOROLUX_ENTER_PHASE(1);
  find_borders(own, borders);
  TOROLUX_LEAVE_PHASE(1);
  TOROLUX_ENTER_PHASE(2);
  const struct numbers come = exchange(own, borders, parts);
  TOROLUX_LEAVE_PHASE(2);
  TOROLUX_ENTER_PHASE(3);
  const struct numbers sorted = merge(come, parts, torolux_pes());
  TOROLUX_LEAVE_PHASE(3);
  torolux_barrier();
  const uint64_t cycles = torolux_clock() - begin;

  if (checked) check(sorted, own);
  uint32_t most = (uint32_t)sorted.count;
  torolux_reduce(0, &most, 1, TOROLUX_UINT32, TOROLUX_MAXIMUM);
  if (torolux_pe() == 0) {
    printf("%lu numbers sorted in %llu cycles; the most on a PE: %lu, %.2f of the mean\n", (unsigned long)all,
           (unsigned long long)cycles, (unsigned long)most, (double)most * torolux_pes() / (double)all);
  }
  return 0;
}
