// SPDX-License-Identifier: MIT
// Errors of links: bits that flip, and that CRC-32 finds.
#include "emulator/torus/link_faults.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <span>

#include "emulator/errors.hpp"
#include "firmware/protocol/random.hpp"

namespace torolux {

namespace {

enum class Purpose : std::uint32_t { error = 1, bit };

std::uint32_t hash(const Block& block, Purpose purpose, std::uint32_t attempt) {
  std::uint32_t key = protocol::hash_combine(static_cast<std::uint32_t>(purpose), attempt);
  key = protocol::hash_combine(key, static_cast<std::uint32_t>(block.number));
  key = protocol::hash_combine(key, static_cast<std::uint32_t>(block.number >> 32U));
  return protocol::hash_combine(key, block.hops);
}

std::uint32_t crc(std::span<const std::byte> data) {
  return static_cast<std::uint32_t>(
      crc32(crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size())));
}

/// Whether a receiver notices that bit `bit` of the block's data has been flipped: compares CRC-32 sums.
bool crc_detects_flip(const Block& block, std::uint32_t bit) {
  const std::span<const std::byte> sent = block.payload();
  std::array<std::byte, kMostBlockBytes> bytes{};
  const std::span<std::byte> received = std::span(bytes).first(sent.size());
  std::ranges::copy(sent, received.begin());
  received[bit / 8] ^= std::byte{1} << (bit % 8);
  return crc(received) != crc(sent);
}

}  // namespace

LinkFaults::LinkFaults(const MachineDescription::Torus& torus)
    : error_threshold_(static_cast<std::uint32_t>(std::clamp(torus.link_error_rate, 0.0, 0.5) * 4294967296.0)) {}

std::uint32_t LinkFaults::count_bad_copies(const Block& block) {
  std::uint32_t bad = 0;
  while (hash(block, Purpose::error, bad) < error_threshold_) {
    const auto bits = static_cast<std::uint32_t>(block.payload().size() * 8);
    if (bits != 0 && !crc_detects_flip(block, hash(block, Purpose::bit, bad) % bits)) {
      throw MachineFailure("a link's CRC-32 did not see a flipped bit");
    }
    ++bad;
    ++retries_;
  }
  return bad;
}

}  // namespace torolux
