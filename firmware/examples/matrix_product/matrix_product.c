// SPDX-License-Identifier: MIT
// The product of two square matrices by Cannon's algorithm (1969), which a torus is made for: each PE holds a block of
// A, B and C. The blocks of row i of A begin i places further west, those of column j of B j places further north;
// then, as often as there are columns of PEs, each PE multiplies what it has, A goes one link west, and B one link
// north. Arguments: the edge of the matrices, a multiple of the edge of the torus, which is square; then "check", if
// each PE is to compute some entries again by the definition.
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <torolux.h>

TOROLUX_PHASE_NAME(0, "multiply");
TOROLUX_PHASE_NAME(1, "shift");
TOROLUX_PHASE_NAME(2, "prepare");
TOROLUX_PHASE_NAME(3, "check");

// Entries are small whole numbers, so that sums are exact in any order.
static float entry_of_a(unsigned row, unsigned column) {
  return (float)((row * 7 + column * 3) & 15) - 8;
}
static float entry_of_b(unsigned row, unsigned column) {
  return (float)((row * 5 + column * 11) & 7) - 3;
}

static float* memory_for(unsigned edge) {
  float* const memory = calloc((size_t)edge * edge, sizeof *memory);
  if (memory == NULL) torolux_fail("no memory for a block: give the PEs more (--pe-memory), or take smaller matrices");
  return memory;
}

enum { kTile = 4 };  // of C, that stays in registers: 16 sums, 4 entries of A, 4 of B

// Loops over a tile are written out by the compiler, which -O2 alone does not do: otherwise the sums lie in memory.
#define EACH_OF_TILE(index) _Pragma("GCC unroll 4") for (unsigned index = 0; index < kTile; ++index)

// c += a b on a tile of c: rows i to i + 3, columns j to j + 3. A function of its own, which has all registers.
__attribute__((noinline)) static void multiply_tile(const float* a, const float* b, float* c, unsigned edge) {
  float sum[kTile][kTile];
  EACH_OF_TILE(i) {
    EACH_OF_TILE(j) sum[i][j] = c[i * edge + j];
  }
  for (unsigned k = 0; k < edge; ++k) {
    const float* const b_row = b + k * edge;
    EACH_OF_TILE(i) {
      const float left = a[i * edge + k];
      EACH_OF_TILE(j) sum[i][j] = __builtin_fmaf(left, b_row[j], sum[i][j]);
    }
  }
  EACH_OF_TILE(i) {
    EACH_OF_TILE(j) c[i * edge + j] = sum[i][j];
  }
}

// What is beyond the last whole tile.
static void multiply_entry(const float* a_row, const float* b_column, float* c, unsigned edge) {
  float sum = *c;
  for (unsigned k = 0; k < edge; ++k) sum = __builtin_fmaf(a_row[k], b_column[k * edge], sum);
  *c = sum;
}

static void multiply(const float* a, const float* b, float* c, unsigned edge) {
  TOROLUX_ENTER_PHASE(0);
  const unsigned tiled = edge / kTile * kTile;
  for (unsigned i = 0; i < tiled; i += kTile) {
    for (unsigned j = 0; j < tiled; j += kTile) multiply_tile(a + i * edge, b + j, c + i * edge + j, edge);
  }
  for (unsigned i = 0; i < edge; ++i) {
    for (unsigned j = i < tiled ? tiled : 0; j < edge; ++j) {
      multiply_entry(a + i * edge, b + j, c + i * edge + j, edge);
    }
  }
  TOROLUX_LEAVE_PHASE(0);
}

// The block goes to one PE while that of another comes; `spare` takes it in, and the two change places.
static void shift(float** block, float** spare, size_t bytes, unsigned to, unsigned from) {
  TOROLUX_ENTER_PHASE(1);
  torolux_exchange((int)to, *block, bytes, (int)from, *spare, bytes);
  float* const came = *spare;
  *spare = *block;
  *block = came;
  TOROLUX_LEAVE_PHASE(1);
}

static void cannon(float** a, float** b, float* c, float** spare, unsigned edge) {
  const int column = (int)torolux_column();
  const int row = (int)torolux_row();
  const unsigned steps = torolux_columns();
  const size_t bytes = (size_t)edge * edge * sizeof **a;
  if (row != 0) shift(a, spare, bytes, torolux_pe_at(column - row, row), torolux_pe_at(column + row, row));
  if (column != 0) shift(b, spare, bytes, torolux_pe_at(column, row - column), torolux_pe_at(column, row + column));
  for (unsigned step = 0; step < steps; ++step) {
    multiply(*a, *b, c, edge);
    if (step + 1 == steps) break;
    shift(a, spare, bytes, torolux_neighbour(TOROLUX_WEST), torolux_neighbour(TOROLUX_EAST));
    shift(b, spare, bytes, torolux_neighbour(TOROLUX_NORTH), torolux_neighbour(TOROLUX_SOUTH));
  }
}

// One entry in each row of the block, by the definition.
static void check(const float* c, unsigned edge, unsigned whole) {
  TOROLUX_ENTER_PHASE(3);
  for (unsigned i = 0; i < edge; ++i) {
    const unsigned j = (i * 13 + 5) % edge;
    const unsigned row = torolux_row() * edge + i;
    const unsigned column = torolux_column() * edge + j;
    float sum = 0;
    for (unsigned k = 0; k < whole; ++k) sum += entry_of_a(row, k) * entry_of_b(k, column);
    if (c[i * edge + j] != sum) torolux_fail("an entry of the product is wrong");
  }
  TOROLUX_LEAVE_PHASE(3);
}

static void fill(float* a, float* b, unsigned edge) {
  TOROLUX_ENTER_PHASE(2);
  const unsigned first_row = torolux_row() * edge;
  const unsigned first_column = torolux_column() * edge;
  for (unsigned i = 0; i < edge; ++i) {
    for (unsigned j = 0; j < edge; ++j) {
      a[i * edge + j] = entry_of_a(first_row + i, first_column + j);
      b[i * edge + j] = entry_of_b(first_row + i, first_column + j);
    }
  }
  TOROLUX_LEAVE_PHASE(2);
}

int main(int argc, char** argv) {
  const unsigned whole = argc >= 2 ? (unsigned)strtoul(argv[1], NULL, 10) : 0;
  const bool checks = argc == 3 && strcmp(argv[2], "check") == 0;
  const unsigned side = torolux_columns();
  if (argc > (checks ? 3 : 2) || whole == 0 || side != torolux_rows() || whole % side != 0) {
    if (torolux_pe() == 0) {
      fprintf(stderr,
              "arguments: the edge of the matrices, a multiple of the edge of the torus, which must be square; "
              "then nothing, or check\n");
    }
    return 1;
  }
  const unsigned edge = whole / side;
  float* a = memory_for(edge);
  float* b = memory_for(edge);
  float* const c = memory_for(edge);
  float* spare = memory_for(edge);
  fill(a, b, edge);
  torolux_barrier();
  const uint64_t begin = torolux_clock();
  cannon(&a, &b, c, &spare, edge);
  torolux_barrier();
  const uint64_t cycles = torolux_clock() - begin;

  if (checks) check(c, edge, whole);
  if (torolux_pe() == 0) printf("%u x %u: %llu cycles\n", whole, whole, (unsigned long long)cycles);
  return 0;
}
