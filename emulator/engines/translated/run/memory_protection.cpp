// SPDX-License-Identifier: MIT
// Physical memory protection (RISC-V privileged architecture, 3.7), with QEMU 7.2's reading of it.
#include <algorithm>
#include <array>

#include "emulator/engines/translated/run/control.hpp"

namespace torolux::translated {
namespace {

constexpr std::uint8_t kLocked = 0x80;
constexpr std::uint32_t kPage = 4096;

enum class Match : std::uint8_t { off, top_of_range, four_bytes, power_of_two };

Match match_of(std::uint8_t config) {
  return static_cast<Match>((config >> 3U) & 3U);
}

/// First and last byte of an entry. As in QEMU an entry that is off has a range, too: it denies what lies across its
/// end, and nothing else.
struct Range {
  std::uint32_t first;
  std::uint32_t last;

  bool holds(std::uint32_t address) const { return address >= first && address <= last; }
};

Range range_of(const TranslatedPe& pe, unsigned entry) {
  const std::uint32_t address = pe.pmpaddr[entry];
  switch (match_of(pe.pmpcfg[entry])) {
    case Match::off:
      return {0, 0xFFFF'FFFFU};
    case Match::top_of_range: {
      const Range range{entry == 0 ? 0 : pe.pmpaddr[entry - 1] << 2U, (address << 2U) - 1U};
      return range.first > range.last ? Range{0, 0} : range;
    }
    case Match::four_bytes:
      return {address << 2U, (address << 2U) + 3U};
    case Match::power_of_two: {
      const std::uint32_t ones = (address << 2U) | 3U;
      return {ones & (ones + 1U), ones | (ones + 1U)};
    }
  }
  return {0, 0};
}

/// An unlocked entry binds machine mode only where mstatus.MPRV lends it another mode's rights.
bool acts_as_user(const TranslatedPe& pe, Access access) {
  constexpr std::uint32_t kMprv = 1U << 17U;
  constexpr std::uint32_t kMpp = 3U << 11U;
  return access != Access::fetch && (pe.mstatus & kMprv) != 0 && (pe.mstatus & kMpp) != kMpp;
}

}  // namespace

bool pmp_allows(const TranslatedPe& pe, std::uint32_t address, std::uint32_t bytes, Access access) {
  const bool user = acts_as_user(pe, access);
  const auto is_off = [](std::uint8_t config) { return match_of(config) == Match::off; };
  if (std::all_of(std::begin(pe.pmpcfg), std::end(pe.pmpcfg), is_off)) return !user;
  for (unsigned i = 0; i < kPmpEntries; ++i) {
    const Range range = range_of(pe, i);
    const bool begins = range.holds(address);
    const bool ends = range.holds(address + bytes - 1);
    if (begins != ends) return false;
    if (!begins || is_off(pe.pmpcfg[i])) continue;
    const bool binds = user || (pe.pmpcfg[i] & kLocked) != 0;
    return !binds || (pe.pmpcfg[i] & static_cast<std::uint8_t>(access)) != 0;
  }
  return !user;
}

std::uint32_t freely_accessible(const TranslatedPe& pe, std::uint32_t begin, std::uint32_t end, Access access) {
  // Rights change at these addresses only.
  std::array<std::uint32_t, 2 * kPmpEntries + 1> borders{};
  std::size_t count = 0;
  for (unsigned i = 0; i < kPmpEntries; ++i) {
    const Range range = range_of(pe, i);
    borders[count++] = range.first;
    borders[count++] = range.last + 1;
  }
  borders[count++] = end;
  std::sort(borders.begin(), borders.end());
  std::uint32_t from = begin;
  for (const std::uint32_t border : borders) {
    if (border <= from || border > end) continue;
    if (!pmp_allows(pe, from, 1, access)) break;
    from = border;
    if (border % kPage != 0) break;  // an access across it is refused
  }
  return from - begin;
}

}  // namespace torolux::translated
