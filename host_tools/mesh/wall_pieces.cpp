// SPDX-License-Identifier: MIT
// Cuts the element where walls cross it, and joins pieces with no wall between their middles. Where fewer than two of
// its parts are seen, the element stays whole.
#include "host_tools/mesh/wall_pieces.hpp"

#include <algorithm>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/edges.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {
namespace {

/// Pieces are cut at most so many times: an element of the length asked for, cut twice at walls already, is followed in
/// steps of a sixteenth. What lies on the wrong side of the steps' edges shows the other side's light.
constexpr std::uint32_t kPieceLevels = 2;

void cut(const Mesh& mesh, std::uint32_t triangle, std::uint32_t code, std::uint32_t levels,
         std::vector<WallPiece>& pieces) {
  if (levels == 0 || !mesh.walls.cross(triangle, code)) {
    pieces.push_back({code, 0});
    return;
  }
  for (std::uint32_t child = 0; child < 4; ++child) cut(mesh, triangle, code << 2U | child, levels - 1, pieces);
}

/// Pieces that see each other over the surface are one part. Returns the number of parts.
std::uint32_t number_parts(const Mesh& mesh, std::uint32_t triangle, std::vector<WallPiece>& pieces) {
  const auto count = static_cast<std::uint32_t>(pieces.size());
  std::vector<PlanePoint> middle;
  middle.reserve(count);
  for (const WallPiece& piece : pieces) middle.push_back(middle_of_grid(piece.code));
  DisjointSets joined(count);
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) {
      if (joined.root(a) != joined.root(b) && !mesh.walls.part(triangle, middle[a], middle[b])) joined.merge(a, b);
    }
  }
  std::vector<std::uint32_t> number(count, count);
  std::uint32_t parts = 0;
  for (std::uint32_t p = 0; p < count; ++p) {
    std::uint32_t& of_root = number[joined.root(p)];
    if (of_root == count) of_root = parts++;
    pieces[p].part = of_root;
  }
  return parts;
}

/// Whether a part is in the open. What a thing hides is not seen, and what is too narrow to tell hardly is.
bool is_seen(const Mesh& mesh, std::uint32_t triangle, const std::vector<WallPiece>& pieces, std::uint32_t part) {
  const auto clear = std::ranges::find_if(
      pieces, [&](const WallPiece& piece) { return piece.part == part && !mesh.walls.touch(triangle, piece.code); });
  return clear != pieces.end() && !is_hidden(mesh, triangle, clear->code);
}

}  // namespace

WallParts wall_parts(const Mesh& mesh, std::uint32_t triangle, std::uint32_t code) {
  const std::uint32_t level = protocol::level_of_code(code);
  std::vector<WallPiece> pieces;
  cut(mesh, triangle, code, std::min(kPieceLevels, protocol::kMostLevels - level), pieces);
  const std::uint32_t count = number_parts(mesh, triangle, pieces);
  const WallPiece whole{code, 0};
  std::vector<WallParts::Part> parts(count, {0, false});
  for (const WallPiece& piece : pieces) {
    parts[piece.part].area += 1.0 / protocol::triangles_of_level(protocol::level_of_code(piece.code) - level);
  }
  for (std::uint32_t part = 0; part < count; ++part) parts[part].seen = is_seen(mesh, triangle, pieces, part);
  const auto seen = [](const WallParts::Part& part) { return part.seen; };
  switch (std::ranges::count_if(parts, seen)) {
    case 0:
      return {{whole}, {{1, false}}};
    case 1:
      return {{whole}, {*std::ranges::find_if(parts, seen)}};
    default:
      return {pieces, parts};
  }
}

}  // namespace torolux
