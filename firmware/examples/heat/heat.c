// SPDX-License-Identifier: MIT
// Heat in a square plate, whose edge is hot on one side: an explicit scheme of finite differences on a grid that is
// spread over the torus by blocks. After each step a PE exchanges the rim of its block with its four neighbours.
// Arguments: points along an edge, and steps. Where a run has `--output plate.ppm=FILE`, the plate is a picture at
// last.
//
// u is the temperature, 0 to 1. New u = u + r (sum of the four neighbours - 4 u), r = 0.2 (stable up to 0.25), computed
// as r sum + (1 - 4 r) u.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <torolux.h>

TOROLUX_PHASE_NAME(0, "compute");
TOROLUX_PHASE_NAME(1, "exchange");
TOROLUX_PHASE_NAME(2, "picture");

static const float kRate = 0.2F;

// A PE's block with a rim of one point on each side; rows lie one behind the other.
struct block {
  unsigned columns, rows;            // without the rim
  unsigned first_column, first_row;  // in the plate
  float* u;                          // (columns + 2) * (rows + 2)
  float* next;                       // likewise
  float *column_out, *column_in;     // rows each: columns do not lie in one piece
};

static void* memory_for(size_t bytes) {
  void* const memory = calloc(1, bytes);
  if (memory == NULL) torolux_fail("no memory for the plate: give the PEs more (--pe-memory), or take fewer points");
  return memory;
}

static float* row_of(const struct block* b, float* u, unsigned row) {
  return u + (size_t)row * (b->columns + 2);
}

// The share of `points` that falls to part `number` of `parts`.
static unsigned share_begin(unsigned points, unsigned number, unsigned parts) {
  return (unsigned)((uint64_t)points * number / parts);
}

static struct block make_block(unsigned points) {
  struct block b;
  b.first_column = share_begin(points, torolux_column(), torolux_columns());
  b.first_row = share_begin(points, torolux_row(), torolux_rows());
  b.columns = share_begin(points, torolux_column() + 1, torolux_columns()) - b.first_column;
  b.rows = share_begin(points, torolux_row() + 1, torolux_rows()) - b.first_row;
  const size_t bytes = (size_t)(b.columns + 2) * (b.rows + 2) * sizeof(float);
  b.u = memory_for(bytes);
  b.next = memory_for(bytes);
  b.column_out = memory_for(b.rows * sizeof(float));
  b.column_in = memory_for(b.rows * sizeof(float));
  return b;
}

// The plate ends where the torus is closed: there the rim keeps the edge's temperature, 1 on top and 0 elsewhere.
static void set_edges(struct block* b) {
  if (torolux_row() != 0) return;
  for (unsigned column = 0; column < b->columns + 2; ++column) {
    b->u[column] = 1;
    b->next[column] = 1;
  }
}

static void exchange_columns(struct block* b, enum torolux_link to, unsigned out, enum torolux_link from, unsigned in,
                             int sends, int receives) {
  const size_t bytes = b->rows * sizeof(float);
  for (unsigned row = 0; row < b->rows; ++row) b->column_out[row] = row_of(b, b->u, row + 1)[out];
  if (sends) torolux_send((int)torolux_neighbour(to), b->column_out, bytes);
  if (!receives) return;
  torolux_receive((int)torolux_neighbour(from), b->column_in, bytes);
  for (unsigned row = 0; row < b->rows; ++row) row_of(b, b->u, row + 1)[in] = b->column_in[row];
}

static void exchange_rims(struct block* b) {
  TOROLUX_ENTER_PHASE(1);
  const int west_edge = torolux_column() == 0;
  const int east_edge = torolux_column() + 1 == torolux_columns();
  const int north_edge = torolux_row() == 0;
  const int south_edge = torolux_row() + 1 == torolux_rows();
  const size_t bytes = b->columns * sizeof(float);
  exchange_columns(b, TOROLUX_EAST, b->columns, TOROLUX_WEST, 0, !east_edge, !west_edge);
  exchange_columns(b, TOROLUX_WEST, 1, TOROLUX_EAST, b->columns + 1, !west_edge, !east_edge);
  const int south = (int)torolux_neighbour(TOROLUX_SOUTH);
  const int north = (int)torolux_neighbour(TOROLUX_NORTH);
  if (!south_edge) torolux_send(south, row_of(b, b->u, b->rows) + 1, bytes);
  if (!north_edge) torolux_receive(north, row_of(b, b->u, 0) + 1, bytes);
  if (!north_edge) torolux_send(north, row_of(b, b->u, 1) + 1, bytes);
  if (!south_edge) torolux_receive(south, row_of(b, b->u, b->rows + 1) + 1, bytes);
  TOROLUX_LEAVE_PHASE(1);
}

// One row, from three. Unrolled, so that what has been loaded stays in registers as three columns move on to the next.
static void compute_row(const float* restrict above, const float* restrict here, const float* restrict below,
                        float* restrict next, unsigned columns) {
  float left = here[0];
  float middle = here[1];
#pragma GCC unroll 4
  for (unsigned column = 1; column <= columns; ++column) {
    const float right = here[column + 1];
    const float around = (above[column] + below[column]) + (left + right);
    next[column] = fmaf(kRate, around, (1 - 4 * kRate) * middle);
    left = middle;
    middle = right;
  }
}

static void compute(struct block* b) {
  TOROLUX_ENTER_PHASE(0);
  for (unsigned row = 1; row <= b->rows; ++row) {
    compute_row(row_of(b, b->u, row - 1), row_of(b, b->u, row), row_of(b, b->u, row + 1), row_of(b, b->next, row),
                b->columns);
  }
  float* const old = b->u;
  b->u = b->next;
  b->next = old;
  TOROLUX_LEAVE_PHASE(0);
}

// For PE 0. Summed in whole numbers, which are the same in any order and so on any torus.
static double mean_temperature(struct block* b, unsigned points) {
  const float unit = 1 << 24;
  uint64_t sum = 0;
  for (unsigned row = 1; row <= b->rows; ++row) {
    const float* const here = row_of(b, b->u, row);
    for (unsigned column = 1; column <= b->columns; ++column) sum += (uint32_t)(unit * here[column]);
  }
  torolux_reduce(0, &sum, 1, TOROLUX_UINT64, TOROLUX_SUM);
  return (double)sum / unit / ((double)points * points);
}

// Black over red and yellow to white.
static void put_colour(unsigned char* pixel, float u) {
  for (int channel = 0; channel < 3; ++channel) {
    const float level = 3 * u - (float)channel;
    pixel[channel] = (unsigned char)(255 * (level < 0 ? 0 : level > 1 ? 1 : level) + 0.5F);
  }
}

// Every PE writes its own rows into the one file; PE 0 the header before.
static void write_picture(struct block* b, unsigned points) {
  FILE* const file = fopen("plate.ppm", "wb");
  if (file == NULL) return;
  TOROLUX_ENTER_PHASE(2);
  char header[32];
  const int header_bytes = snprintf(header, sizeof header, "P6 %u %u 255\n", points, points);
  if (torolux_pe() == 0) fwrite(header, 1, (size_t)header_bytes, file);
  unsigned char* const line = memory_for(3 * b->columns);
  for (unsigned row = 0; row < b->rows; ++row) {
    for (unsigned column = 0; column < b->columns; ++column) {
      put_colour(line + 3 * column, row_of(b, b->u, row + 1)[column + 1]);
    }
    fseek(file, header_bytes + 3 * (long)((b->first_row + row) * points + b->first_column), SEEK_SET);
    fwrite(line, 3, b->columns, file);
  }
  free(line);
  fclose(file);
  TOROLUX_LEAVE_PHASE(2);
}

int main(int argc, char** argv) {
  const unsigned points = argc == 3 ? (unsigned)strtoul(argv[1], NULL, 10) : 0;
  const unsigned steps = argc == 3 ? (unsigned)strtoul(argv[2], NULL, 10) : 0;
  if (points < torolux_columns() || points < torolux_rows()) {
    if (torolux_pe() == 0)
      fprintf(stderr, "arguments: POINTS STEPS, at least a point for each column and row of PEs\n");
    return 1;
  }
  struct block block = make_block(points);
  set_edges(&block);

  torolux_barrier();
  const uint64_t begin = torolux_clock();
  for (unsigned step = 0; step < steps; ++step) {
    exchange_rims(&block);
    compute(&block);
  }
  torolux_barrier();
  const uint64_t cycles = torolux_clock() - begin;

  const double mean = mean_temperature(&block, points);
  if (torolux_pe() == 0) {
    printf("%u x %u points, %u steps: %llu cycles; mean temperature %.6f\n", points, points, steps,
           (unsigned long long)cycles, mean);
  }
  write_picture(&block, points);
  return 0;
}
