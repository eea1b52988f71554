// SPDX-License-Identifier: MIT
// Decodes executable segments.
#include "emulator/engines/translated/decode/code_map.hpp"

#include <algorithm>

#include "emulator/engines/isa/instruction_class.hpp"

namespace torolux::translated {

CodeMap::CodeMap(const Image& image, const LatencyTable& latency) {
  constexpr std::uint32_t kPage = 4096;
  std::uint32_t begin = 0xFFFF'FFFFU;
  std::uint32_t end = 0;
  for (const ImageSegment& segment : image.segments) {
    if (!segment.executable) continue;
    begin = std::min(begin, segment.address & ~1U);
    end = std::max(end, segment.address + segment.memory_bytes);
  }
  begin_ = begin;
  instructions_.resize((end - begin + 1) / 2);
  for (const ImageSegment& segment : image.segments) {
    if (segment.executable) decode_segment(segment, latency);
  }
  store_base_ = (end + kPage - 1) / kPage * kPage;
}

void CodeMap::decode_segment(const ImageSegment& segment, const LatencyTable& latency) {
  spans_.push_back({segment.address, segment.address + segment.memory_bytes});
  const auto byte_at = [&](std::uint32_t offset) {
    return offset < segment.contents.size() ? std::to_integer<std::uint32_t>(segment.contents[offset]) : 0U;
  };
  const std::uint32_t first = segment.address % 2;
  for (std::uint32_t offset = first; offset + 2 <= segment.memory_bytes; offset += 2) {
    std::uint32_t bits = byte_at(offset) | byte_at(offset + 1) << 8U;
    const std::uint32_t bytes = bytes_of(bits);
    if (offset + bytes > segment.memory_bytes) continue;
    if (bytes == 4) bits |= byte_at(offset + 2) << 16U | byte_at(offset + 3) << 24U;
    PlacedInstruction& placed = instructions_[(segment.address + offset - begin_) / 2];
    placed.instruction = decode(bits);
    const bool counts = !is_phase_marker(bits);
    placed.cost = {cycles_of(bits, latency), counts ? 1U : 0U};
  }
}

bool CodeMap::holds_code(std::uint32_t address, std::uint32_t bytes) const {
  return std::any_of(spans_.begin(), spans_.end(), [&](const Span& span) {
    return address < span.end && (address + bytes > span.begin || address + bytes < address);
  });
}

}  // namespace torolux::translated
