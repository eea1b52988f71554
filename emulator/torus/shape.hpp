// SPDX-License-Identifier: MIT
// The torus as a graph: numbers of PEs in, neighbours and routes out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace torolux {

/// Ports of a router. Data leave east by the east output and enter the neighbour's west input.
enum class Port : std::uint8_t { east, west, south, north, local };
inline constexpr std::size_t kPorts = 5;
inline constexpr std::array<std::string_view, 4> kLinkNames = {"east", "west", "south", "north"};
inline constexpr std::size_t kLinks = 4;
constexpr std::size_t index_of(Port port) {
  return static_cast<std::size_t>(port);
}
/// The other end's port of the same link.
constexpr Port opposite(Port port) {
  constexpr std::array<Port, kPorts> kOpposite = {Port::west, Port::east, Port::north, Port::south, Port::local};
  return kOpposite[index_of(port)];
}

/// The same of its number.
constexpr std::size_t opposite_link(std::size_t port) {
  return index_of(opposite(static_cast<Port>(port)));
}

/// Routers are numbered row by row, as PEs are; east raises x, south raises y.
class TorusShape {
 public:
  TorusShape(unsigned columns, unsigned rows) : columns_(columns), rows_(rows) {}

  unsigned columns() const { return columns_; }
  unsigned rows() const { return rows_; }
  unsigned routers() const { return columns_ * rows_; }
  unsigned diameter() const { return columns_ / 2 + rows_ / 2; }  ///< most links between two PEs

  struct Place {
    std::uint16_t x, y;
  };
  Place place(unsigned router) const {
    return {static_cast<std::uint16_t>(router % columns_), static_cast<std::uint16_t>(router / columns_)};
  }

  unsigned neighbour(unsigned router, Port port) const {
    const unsigned x = router % columns_;
    const unsigned y = router / columns_;
    switch (port) {
      case Port::east:
        return y * columns_ + (x + 1) % columns_;
      case Port::west:
        return y * columns_ + (x + columns_ - 1) % columns_;
      case Port::south:
        return (y + 1) % rows_ * columns_ + x;
      case Port::north:
        return (y + rows_ - 1) % rows_ * columns_ + x;
      default:
        return router;
    }
  }

  /// Dimension order: x first, the shorter way. At half a ring the way is fixed for each pair: a packet that starts at
  /// an even coordinate goes up, at an odd one down, which loads both directions alike.
  Port route(Place from, Place to) const {
    if (from.x != to.x) return step(from.x, to.x, columns_) ? Port::east : Port::west;
    if (from.y != to.y) return step(from.y, to.y, rows_) ? Port::south : Port::north;
    return Port::local;
  }
  /// The same for one that has come there by this output of the router before: it goes on as long as it has to.
  Port route_on(Port output, Place from, Place to) const {
    const bool along_x = output == Port::east || output == Port::west;
    return (along_x ? from.x != to.x : from.y != to.y) ? output : route(from, to);
  }
  Port route(unsigned router, unsigned destination) const { return route(place(router), place(destination)); }

  /// Links between two PEs.
  unsigned hops(unsigned from, unsigned to) const {
    return ring_distance(from % columns_, to % columns_, columns_) +
           ring_distance(from / columns_, to / columns_, rows_);
  }

 private:
  /// Whether the way from one coordinate of a ring to another goes up.
  static bool step(unsigned from, unsigned to, unsigned size) {
    const unsigned up = to >= from ? to - from : to + size - from;
    return 2 * up != size ? 2 * up < size : from % 2 == 0;
  }
  static unsigned ring_distance(unsigned from, unsigned to, unsigned size) {
    const unsigned up = to >= from ? to - from : to + size - from;
    return up < size - up ? up : size - up;
  }

  unsigned columns_;
  unsigned rows_;
};

}  // namespace torolux
