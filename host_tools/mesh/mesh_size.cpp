// SPDX-License-Identifier: MIT
// Triangles with their edges, and lengths, enter; counts, or a refusal with greater lengths, leave.
#include "host_tools/mesh/mesh_size.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "emulator/errors.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {
namespace {

bool is_too_much(const MeshSize& size, std::uint64_t machine_bytes) {
  return size.elements > kSoonMade && size.bytes() > machine_bytes;
}

bool is_possible(const MeshSize& size, std::uint64_t machine_bytes) {
  return size.elements <= kMostElements && size.patch_sides <= kMostPatchSides && !is_too_much(size, machine_bytes);
}

/// No less than the length itself.
std::string three_digits(double length) {
  const double unit = std::pow(10.0, std::floor(std::log10(length)) - 2);
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", std::ceil(length / unit) * unit);
  return text.data();
}

/// The next ones by steps of 2^(1/2) that are possible.
MeshLengths greater(std::span<const SizedTriangle> triangles, const MeshLengths& lengths, std::uint64_t machine_bytes) {
  MeshLengths next = lengths;
  for (double least = std::min(lengths.patch, lengths.element);
       !is_possible(least_size(triangles, next), machine_bytes) && std::isfinite(least); least *= std::sqrt(2)) {
    next.patch = std::max(lengths.patch, least);
    next.element = std::max(lengths.element, least);
  }
  return next;
}

}  // namespace

std::uint64_t MeshSize::bytes() const {
  const std::uint64_t facets = elements / 2;  // both sides share one
  return patches * (sizeof(protocol::Patch) + sizeof(protocol::PatchReference) + sizeof(protocol::PatchPart)) +
         patch_sides * sizeof(protocol::PatchSide) + elements * sizeof(protocol::Element) +
         facets * sizeof(protocol::Facet);
}

MeshSize least_size(std::span<const SizedTriangle> triangles, const MeshLengths& lengths) {
  MeshSize size;
  for (const auto& [longest_edge, sides] : triangles) {
    const std::uint32_t patch = level_for(longest_edge, lengths.patch);
    const std::uint32_t element = std::max<std::uint32_t>(patch, level_for(longest_edge, lengths.element));
    if (element == 0) continue;
    size.patches += protocol::triangles_of_level(patch);
    size.patch_sides += std::uint64_t{sides} * protocol::triangles_of_level(patch);
    size.elements += std::uint64_t{sides} * protocol::triangles_of_level(element);
  }
  return size;
}

void require_possible(std::span<const SizedTriangle> triangles, const MeshLengths& lengths,
                      std::uint64_t machine_bytes) {
  const MeshSize size = least_size(triangles, lengths);
  if (is_possible(size, machine_bytes)) return;
  const MeshLengths next = greater(triangles, lengths, machine_bytes);
  std::string text = "--elements and --patches ask for " + std::to_string(size.elements) + " elements and " +
                     std::to_string(size.patch_sides) + " patches on all sides";
  if (is_too_much(size, machine_bytes))
    text += ", " + std::to_string(size.bytes()) + " bytes, and all PEs together have " + std::to_string(machine_bytes);
  else
    text += "; at most " + std::to_string(kMostElements) + " and " + std::to_string(kMostPatchSides) + " are allowed";
  text += ": use at least";
  if (next.element > lengths.element) text += " --elements " + three_digits(next.element);
  if (next.patch > lengths.patch) text += " --patches " + three_digits(next.patch);
  throw InputError(text + (is_too_much(size, machine_bytes) ? ", more --pes or more --pe-memory" : ""));
}

}  // namespace torolux
