// SPDX-License-Identifier: MIT
// Faults of links: errors found by CRC-32 and sent again, delays injected to shake the order of events.
#include "emulator/torus/link_faults.hpp"

#include <zlib.h>

#include <algorithm>

#include "emulator/errors.hpp"
#include "firmware/protocol/random.hpp"

namespace torolux {

namespace {

enum class Purpose : std::uint32_t { error = 1, bit, delay };

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

}  // namespace

LinkFaults::LinkFaults(const MachineDescription::Torus& torus, std::uint32_t injected_delay)
    : error_threshold_(static_cast<std::uint32_t>(std::clamp(torus.link_error_rate, 0.0, 0.5) * 4294967296.0)),
      retry_cycles_(torus.retry_cycles),
      injected_delay_(injected_delay) {}

std::uint64_t LinkFaults::cycles_lost(const Block& block) {
  std::uint64_t lost = 0;
  if (injected_delay_ != 0) lost = hash(block, Purpose::delay, 0) % (std::uint64_t{injected_delay_} + 1);
  for (std::uint32_t attempt = 0; hash(block, Purpose::error, attempt) < error_threshold_; ++attempt) {
    const std::uint32_t bits = block.bytes * 8;
    if (bits != 0 && !crc_detects_flip(block, hash(block, Purpose::bit, attempt) % bits)) {
      throw MachineFailure("a link's CRC-32 did not see a flipped bit");
    }
    lost += block.flits + retry_cycles_;
    ++retries_;
  }
  return lost;
}

bool crc_detects_flip(const Block& block, std::uint32_t bit) {
  Block received = block;
  received.data[bit / 8] ^= std::byte{1} << (bit % 8);
  return crc(received.payload()) != crc(block.payload());
}

}  // namespace torolux
