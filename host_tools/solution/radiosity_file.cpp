// SPDX-License-Identifier: MIT
// Bytes are written behind a head with version and CRC-32. On the way back all is checked against the head, this run's
// scene and settings, and what flux there can be.
#include "host_tools/solution/radiosity_file.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

#include "emulator/errors.hpp"
#include "firmware/protocol/flux.hpp"
#include "host_tools/files/write_file.hpp"

namespace torolux {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian, written as it lies in memory");

struct Head {
  std::array<char, 6> magic;
  std::uint16_t version;
  std::uint32_t crc;  ///< CRC-32 (IEEE 802.3) of all that follows
  std::uint32_t unused;
  std::uint64_t bytes;  ///< that follow
};
static_assert(sizeof(Head) == 24);
constexpr std::array<char, 6> kMagic{'T', 'L', 'X', 'R', 'A', 'D'};
constexpr std::uint16_t kVersion = 9;

struct SavedSums {
  protocol::Tally tally;
  protocol::Flux emitted_shot;
  protocol::Flux reflected_shot;
  protocol::Flux sky_shot;
  std::uint64_t shots;
};
static_assert(sizeof(SavedSums) == 240);

constexpr auto make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = (value & 1U) != 0 ? (value >> 1U) ^ 0xEDB8'8320U : value >> 1U;
    table[i] = value;
  }
  return table;
}

std::uint32_t crc32(std::span<const std::byte> bytes) {
  static constexpr auto table = make_crc_table();
  std::uint32_t crc = 0xFFFF'FFFFU;
  for (const std::byte byte : bytes) crc = table[(crc ^ static_cast<std::uint32_t>(byte)) & 0xFFU] ^ (crc >> 8U);
  return ~crc;
}

/// Writes `value` at the start of `bytes` and moves on; the caller has made room.
template <typename T>
void put(std::span<std::byte>& bytes, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::memcpy(bytes.data(), &value, sizeof value);
  bytes = bytes.subspan(sizeof value);
}

/// The next T of `bytes`; the caller has checked the length.
template <typename T>
T take(std::span<const std::byte>& bytes) {
  T value{};
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes = bytes.subspan(sizeof value);
  return value;
}

void check_origin(const RadiosityOrigin& saved, const RadiosityOrigin& run, const std::string& name) {
  check_origin_settings(saved, run, name);
  if (saved.patch_sides != run.patch_sides || saved.elements != run.elements)
    throw InputError(name + ": these radiosities are of " + std::to_string(saved.patch_sides) + " patch sides and " +
                     std::to_string(saved.elements) + " elements, the scene has " + std::to_string(run.patch_sides) +
                     " and " + std::to_string(run.elements) + "; make them anew, with --save-radiosity");
}

/// Sums of all light stay far below this, so that nothing overflows where values are added up.
constexpr std::int64_t kMostFlux = std::int64_t{1} << 57U;

/// Adds up what is read, and refuses sums that no scene has.
class FluxSum {
 public:
  void add(const protocol::Flux& flux, const std::string& name) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum_[c] += flux[c];
      if (sum_[c] > 16 * kMostFlux) throw InputError(name + ": damaged: more flux than any scene has");
    }
  }

 private:
  protocol::Flux sum_{};
};

void check_flux(const protocol::Flux& flux, const std::string& name) {
  for (const std::int64_t value : flux) {
    if (value < 0 || value > kMostFlux) throw InputError(name + ": damaged: a flux is out of range");
  }
}

void check_gathered(const SolvedElement& element, const std::string& name) {
  if (element.points > protocol::kMostGatherPoints || element.unused != 0)
    throw InputError(name + ": damaged: an element has gathered from more points than it can");
  for (const std::int64_t value : element.gathered) {
    // Of each of its points no more than a flux.
    const bool fits = value >= 0 && (element.points > 0 ? value / element.points <= kMostFlux : value == 0);
    if (!fits) throw InputError(name + ": damaged: a flux is out of range");
  }
}

}  // namespace

std::vector<std::byte> pack_radiosity(const RadiosityOrigin& origin, std::span<const Split> splits,
                                      const Solution& solution) {
  const std::size_t length = sizeof(OriginBytes) + sizeof(std::uint64_t) + splits.size_bytes() + sizeof(SavedSums) +
                             solution.sides.size() * sizeof(SolvedSide) +
                             solution.elements.size() * sizeof(SolvedElement);
  std::vector<std::byte> bytes(sizeof(Head) + length);
  std::span<std::byte> rest = std::span(bytes).subspan(sizeof(Head));
  put(rest, bytes_of(origin));
  put(rest, std::uint64_t{splits.size()});
  for (const Split& split : splits) put(rest, split);
  put(rest,
      SavedSums{solution.tally, solution.emitted_shot, solution.reflected_shot, solution.sky_shot, solution.shots});
  for (const SolvedSide& side : solution.sides) put(rest, side);
  for (const SolvedElement& element : solution.elements) put(rest, element);
  std::span<std::byte> start = bytes;
  put(start, Head{kMagic, kVersion, crc32(start.subspan(sizeof(Head))), 0, length});
  return bytes;
}

SavedRadiosity parse_radiosity(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.size() < sizeof(Head))
    throw InputError(name + ": not a radiosity file: only " + std::to_string(bytes.size()) + " bytes");
  const Head head = take<Head>(bytes);
  if (head.magic != kMagic) throw InputError(name + ": not a radiosity file");
  if (head.version != kVersion) {
    throw InputError(name + ": radiosity file of version " + std::to_string(head.version) + ", this program reads " +
                     std::to_string(kVersion));
  }
  if (head.bytes != bytes.size() || bytes.size() < sizeof(OriginBytes) + sizeof(std::uint64_t)) {
    throw InputError(name + ": cut short or too long: " + std::to_string(bytes.size()) + " bytes after the head, " +
                     std::to_string(head.bytes) + " expected");
  }
  if (head.unused != 0 || crc32(bytes) != head.crc) throw InputError(name + ": damaged: its CRC-32 does not match");
  SavedRadiosity saved{name, origin_of(take<OriginBytes>(bytes)), {}, {}};
  const auto count = take<std::uint64_t>(bytes);
  if (count > bytes.size() / sizeof(Split)) throw InputError(name + ": damaged: its splits do not fit in");
  saved.splits.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    saved.splits.push_back(take<Split>(bytes));
    if (i > 0 && !(saved.splits[i - 1] < saved.splits[i])) throw InputError(name + ": damaged: splits out of order");
  }
  saved.rest.assign(bytes.begin(), bytes.end());
  return saved;
}

void check_radiosity(const SavedRadiosity& saved, const Scene& scene, const Quality& quality) {
  check_origin_settings(saved.origin, radiosity_origin(scene, quality, Mesh{}), saved.name);
}

Solution unpack_radiosity(const SavedRadiosity& saved, const RadiosityOrigin& expected, const Mesh& mesh) {
  const std::string& name = saved.name;
  std::span<const std::byte> bytes = saved.rest;
  check_origin(saved.origin, expected, name);
  const std::uint64_t needed = sizeof(SavedSums) + std::uint64_t{mesh.patch_sides} * sizeof(SolvedSide) +
                               std::uint64_t{mesh.elements} * sizeof(SolvedElement);
  if (bytes.size() != needed) throw InputError(name + ": damaged: its sides and elements do not fill it");
  const auto sums = take<SavedSums>(bytes);
  Solution solution;
  solution.tally = sums.tally;
  solution.emitted_shot = sums.emitted_shot;
  solution.reflected_shot = sums.reflected_shot;
  solution.sky_shot = sums.sky_shot;
  solution.shots = sums.shots;
  for (const protocol::Flux* flux :
       {&sums.tally.absorbed_specular, &sums.tally.reflected_glossy, &sums.tally.escaped, &sums.tally.cut_off,
        &sums.tally.back_side, &sums.emitted_shot, &sums.reflected_shot, &sums.sky_shot}) {
    check_flux(*flux, name);
  }
  for (const std::int64_t rest : sums.tally.sky_rest)  // of few records it may be less than nothing
    check_flux({std::abs(rest), 0, 0}, name);
  FluxSum side_sum;
  solution.sides.reserve(mesh.patch_sides);
  for (std::uint32_t i = 0; i < mesh.patch_sides; ++i) {
    const SolvedSide& side = solution.sides.emplace_back(take<SolvedSide>(bytes));
    for (const protocol::Flux* flux : {&side.incident, &side.shot, &side.emission}) check_flux(*flux, name);
    side_sum.add(side.incident, name);
    side_sum.add(side.emission, name);
    for (std::size_t c = 0; c < 3; ++c) {
      if (side.shot[c] > side.incident[c]) throw InputError(name + ": damaged: a side shot more than it received");
    }
  }
  FluxSum element_sum;
  solution.elements.reserve(mesh.elements);
  for (std::uint32_t i = 0; i < mesh.elements; ++i) {
    const SolvedElement& element = solution.elements.emplace_back(take<SolvedElement>(bytes));
    check_flux(element.flux, name);
    check_flux(element.apart, name);
    check_gathered(element, name);
    element_sum.add(element.flux, name);
  }
  return solution;
}

void save_radiosity(const std::filesystem::path& file, const RadiosityOrigin& origin, std::span<const Split> splits,
                    const Solution& solution) {
  write_file(file, pack_radiosity(origin, splits, solution));
}

SavedRadiosity read_radiosity(const std::filesystem::path& file) {
  constexpr std::uint64_t most = sizeof(Head) + kMostElements * (sizeof(SolvedElement) + sizeof(SolvedSide));
  return parse_radiosity(read_file(file, most), file.string());
}

}  // namespace torolux
