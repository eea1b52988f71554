// SPDX-License-Identifier: MIT
// Trees, chains and rounds of messages between all PEs.
#include "firmware/kit/together.hpp"

#include <algorithm>
#include <array>

namespace torolux::kit {
namespace {

/// Longer data go in pieces of one packet: while a piece is at one PE the next is at the one before.
constexpr std::size_t kPiece = kMostPayload;
static_assert(kPiece % sizeof(std::uint64_t) == 0, "values are not cut");
/// From so many pieces on a chain of PEs, each busy with its own link, beats a tree whose root sends all of it again
/// and again.
constexpr std::size_t kPiecesForChains = 4;

template <class Bytes, class Action>
void in_pieces(Bytes data, Action action) {
  for (std::size_t at = 0; at < data.size(); at += kPiece) {
    action(data.subspan(at, std::min(kPiece, data.size() - at)));
  }
}

}  // namespace

void Together::send(std::uint32_t pe, std::span<const std::byte> data) {
  messenger_.send(Channel::together, static_cast<int>(pe), data);
}

void Together::receive(std::uint32_t pe, std::span<std::byte> data) {
  const std::size_t bytes = messenger_.receive(Channel::together, static_cast<int>(pe), data);
  if (bytes != data.size()) {
    messenger_.fail(Words() << "PE " << pe << " takes part with " << bytes << " bytes where this one has "
                            << data.size() << ": all PEs must call the same, in the same order");
  }
}

// ---- Barrier ----

/// After round k each has heard, by others, of 2^(k+1) - 1 places before its own (Hensgen, Finkel & Manber 1988).
void Together::dissemination(std::uint32_t place, std::uint32_t places, std::uint32_t first, std::uint32_t step) {
  for (std::uint32_t distance = 1; distance < places; distance *= 2) {
    send(first + (place + distance) % places * step, {});
    receive(first + (place + places - distance) % places * step, {});
  }
}

/// First all of a row know of each other, then all rows.
void Together::barrier() {
  const std::uint32_t column = own() % columns();
  const std::uint32_t row = own() / columns();
  dissemination(column, columns(), row * columns(), 1);
  dissemination(row, rows(), column, columns());
}

// ---- Broadcast ----

Together::Place Together::place_from(std::uint32_t root, std::uint32_t pe) {
  return {(pe % columns() + columns() - root % columns()) % columns(),
          (pe / columns() + rows() - root / columns()) % rows()};
}

std::uint32_t Together::pe_at(std::uint32_t root, Place place) {
  return (place.row + root / columns()) % rows() * columns() + (place.column + root % columns()) % columns();
}

void Together::broadcast(std::uint32_t root, std::span<std::byte> data) {
  if (root >= pes())
    messenger_.fail(Words() << "there is no PE " << root << "; the machine has PEs 0 to " << pes() - 1);
  if (data.size() > kMostMessage) {
    messenger_.fail(Words() << data.size() << " bytes for all PEs; the most is " << kMostMessage);
  }
  if (data.size() <= kPiecesForChains * kPiece) {
    broadcast_by_tree(root, data);
  } else {
    broadcast_by_chains(root, data);
  }
}

/// Binomial tree over the numbers of the places counted from the root: sends stay in a row as long as they can.
void Together::broadcast_by_tree(std::uint32_t root, std::span<std::byte> data) {
  const Place place = place_from(root, own());
  const std::uint32_t number = place.row * columns() + place.column;
  const auto pe_of = [&](std::uint32_t other) { return pe_at(root, {other % columns(), other / columns()}); };
  std::uint32_t bit = 1;
  while (bit < pes() && (number & bit) == 0) bit *= 2;
  if (number != 0) receive(pe_of(number - bit), data);
  for (bit /= 2; bit != 0; bit /= 2) {
    if (number + bit < pes()) send(pe_of(number + bit), data);
  }
}

/// Along the root's row, and from each of its PEs down its column.
void Together::broadcast_by_chains(std::uint32_t root, std::span<std::byte> data) {
  const Place place = place_from(root, own());
  in_pieces(data, [&](std::span<std::byte> piece) {
    if (place.row != 0) {
      receive(pe_at(root, {place.column, place.row - 1}), piece);
    } else if (place.column != 0) {
      receive(pe_at(root, {place.column - 1, 0}), piece);
    }
    if (place.row == 0 && place.column + 1 < columns()) send(pe_at(root, {place.column + 1, 0}), piece);
    if (place.row + 1 < rows()) send(pe_at(root, {place.column, place.row + 1}), piece);
  });
}

// ---- Reduce ----

void Together::reduce_to_first(std::span<std::byte> data, Join join) {
  alignas(8) std::array<std::byte, kPiece> other;  // NOLINT(cppcoreguidelines-pro-type-member-init): received into
  in_pieces(data, [&](std::span<std::byte> piece) {
    for (std::uint32_t bit = 1; bit < pes(); bit *= 2) {
      if ((own() & bit) != 0) return send(own() - bit, piece);
      if (own() + bit >= pes()) continue;
      const auto theirs = std::span(other).first(piece.size());
      receive(own() + bit, theirs);
      join(piece, theirs);
    }
  });
}

void Together::reduce(std::uint32_t root, std::span<std::byte> data, Join join) {
  if (root >= pes())
    messenger_.fail(Words() << "there is no PE " << root << "; the machine has PEs 0 to " << pes() - 1);
  reduce_to_first(data, join);
  if (root == 0) return;
  if (own() == 0) send(root, data);
  if (own() == root) receive(0, data);
}

void Together::all_reduce(std::span<std::byte> data, Join join) {
  reduce_to_first(data, join);
  broadcast(0, data);
}

}  // namespace torolux::kit
