// SPDX-License-Identifier: MIT
// torolux.h: where am I. Enters: the NIU window; leaves: numbers.
#include "firmware/kit/include/torolux.h"
#include "firmware/kit/kit.hpp"

namespace torolux::kit {
namespace {

const protocol::NiuWindow& window() {
  return messenger().niu().window();
}

/// The remainder that is never negative.
unsigned wrapped(int value, unsigned size) {
  const int rest = value % static_cast<int>(size);
  return static_cast<unsigned>(rest < 0 ? rest + static_cast<int>(size) : rest);
}

}  // namespace
}  // namespace torolux::kit

using torolux::kit::window;
using torolux::kit::wrapped;

unsigned torolux_pe() {
  return window().pe;
}
unsigned torolux_pes() {
  return window().columns * window().rows;
}
unsigned torolux_columns() {
  return window().columns;
}
unsigned torolux_rows() {
  return window().rows;
}
unsigned torolux_column() {
  return window().pe % window().columns;
}
unsigned torolux_row() {
  return window().pe / window().columns;
}
unsigned torolux_pe_at(int column, int row) {
  return wrapped(row, window().rows) * window().columns + wrapped(column, window().columns);
}
unsigned torolux_neighbour(enum torolux_link link) {
  const int column = static_cast<int>(torolux_column());
  const int row = static_cast<int>(torolux_row());
  switch (link) {
    case TOROLUX_EAST:
      return torolux_pe_at(column + 1, row);
    case TOROLUX_WEST:
      return torolux_pe_at(column - 1, row);
    case TOROLUX_SOUTH:
      return torolux_pe_at(column, row + 1);
    case TOROLUX_NORTH:
      return torolux_pe_at(column, row - 1);
  }
  using torolux::kit::Words;
  torolux::kit::messenger("torolux_neighbour", TOROLUX_CALLER)
      .fail(Words() << "there is no link " << static_cast<int>(link)
                    << "; there are TOROLUX_EAST (0) to TOROLUX_NORTH (3)");
}
size_t torolux_memory_bytes() {
  return window().local_memory_bytes;
}
