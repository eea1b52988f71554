// SPDX-License-Identifier: MIT
// Text enters, checked values leave.
#include "host_tools/cli/parse_values.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <vector>

#include "emulator/errors.hpp"
#include "emulator/nearest_name.hpp"
#include "firmware/protocol/machine.hpp"
#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

std::string in_quotes(std::string_view text) {
  return "\"" + std::string(text) + "\"";
}

[[noreturn]] void wrong_form(std::string_view text, const std::string& expected) {
  throw UsageError(in_quotes(text) + " is not " + expected);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// Digits only. Absent where it is anything else; the largest value where there are too many digits.
std::optional<std::uint64_t> whole(std::string_view text) {
  if (text.empty() || text.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  std::uint64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec == std::errc::result_out_of_range) return std::numeric_limits<std::uint64_t>::max();
  return value;
}

std::optional<double> real(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size() || text.empty()) return std::nullopt;
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::uint32_t in_range(std::string_view text, std::uint64_t value, std::uint64_t least, std::uint64_t most) {
  if (value < least || value > most)
    throw InputError(in_quotes(text) + " is out of range: " + std::to_string(least) + " to " + std::to_string(most) +
                     " are allowed");
  return static_cast<std::uint32_t>(value);
}

template <std::size_t N>
std::array<std::uint32_t, N> parse_sizes(const std::string& text, const std::string& expected, std::uint64_t least,
                                         std::uint64_t most) {
  const auto parts = split(text, 'x');
  if (parts.size() != N) wrong_form(text, expected);
  std::array<std::uint64_t, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    const auto value = whole(parts[i]);
    if (!value) wrong_form(text, expected);
    values[i] = *value;
  }
  std::array<std::uint32_t, N> result{};
  for (std::size_t i = 0; i < N; ++i) result[i] = in_range(text, values[i], least, most);
  return result;
}

/// Of all of a text between separators; absent: one of them is no whole number of 32 bits.
std::optional<std::vector<std::uint32_t>> numbers(std::string_view text, char separator) {
  std::vector<std::uint32_t> all;
  for (const std::string_view part : split(text, separator)) {
    const auto number = whole(part);
    if (!number || *number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
    all.push_back(static_cast<std::uint32_t>(*number));
  }
  return all;
}

/// Takes K (2^10), M or G off the end of a size where it is among `units`; the power of two that it stands for.
unsigned take_unit(std::string_view& size, std::string_view units) {
  if (size.empty()) return 0;
  const char unit = static_cast<char>(size.back() >= 'a' ? size.back() - 'a' + 'A' : size.back());
  const std::size_t place = units.find(unit);
  if (place == std::string_view::npos) return 0;
  size.remove_suffix(1);
  return 10 * (static_cast<unsigned>(place) + 1);
}

constexpr const char* kPeListForm = "a list of PEs like 0-3,7";

/// A PE of the largest machine.
unsigned pe_number(std::string_view text, const std::string& expected) {
  const auto number = whole(text);
  if (!number) wrong_form(text, expected);
  return in_range(text, *number, 0, protocol::kMostPes - 1);
}

}  // namespace

std::array<std::uint32_t, 2> parse_pair(const std::string& text, std::uint32_t least, std::uint32_t most) {
  return parse_sizes<2>(text, "two whole numbers like 640x480", least, most);
}

std::array<std::uint32_t, 2> parse_pes(const std::string& text) {
  const auto pes = parse_sizes<2>(text, "columns and rows of PEs like 4x4", 1, protocol::kMostPes);
  const std::uint64_t all = std::uint64_t{pes[0]} * pes[1];
  if (all > protocol::kMostPes)
    throw InputError(in_quotes(text) + " are " + std::to_string(all) + " PEs; at most " +
                     std::to_string(protocol::kMostPes) + " are allowed");
  return pes;
}

std::optional<std::array<std::uint32_t, 3>> parse_subspaces(const std::string& text) {
  if (text == "auto") return std::nullopt;
  return parse_sizes<3>(text, "three whole numbers like 8x8x8, or auto", 1, kMostSubspacesPerAxis);
}

std::uint32_t parse_memory(const std::string& text) {
  std::string_view digits = text;
  const unsigned shift = take_unit(digits, "KM");
  const auto number = whole(digits);
  if (!number) wrong_form(text, "a size like 512K, 64M or a number of bytes");
  const bool huge = *number > protocol::kLargestLocalMemory;
  const std::uint64_t bytes = huge ? *number : *number << shift;
  if (bytes < protocol::kSmallestLocalMemory || bytes > protocol::kLargestLocalMemory)
    throw InputError(in_quotes(text) + " is out of range: " + bytes_text(protocol::kSmallestLocalMemory) + " to " +
                     bytes_text(protocol::kLargestLocalMemory) + " per PE are allowed");
  if (bytes % protocol::kPageBytes != 0)
    throw InputError(in_quotes(text) + " is not a multiple of " + bytes_text(protocol::kPageBytes));
  return static_cast<std::uint32_t>(bytes);
}

std::vector<unsigned> parse_pe_list(const std::string& text) {
  std::vector<unsigned> pes;
  for (const std::string_view part : split(text, ',')) {
    const auto ends = split(part, '-');
    if (ends.size() > 2) wrong_form(text, kPeListForm);
    const unsigned first = pe_number(ends.front(), kPeListForm);
    const unsigned last = pe_number(ends.back(), kPeListForm);
    if (last < first) throw InputError(in_quotes(part) + " ends before it begins");
    for (unsigned pe = first; pe <= last; ++pe) pes.push_back(pe);
  }
  std::ranges::sort(pes);
  pes.erase(std::unique(pes.begin(), pes.end()), pes.end());
  return pes;
}

std::array<std::uint64_t, 2> parse_window(const std::string& text) {
  constexpr const char* kForm = "a window of cycles like 1000000:2000000, 1000000: or :2000000";
  const auto ends = split(text, ':');
  if (ends.size() != 2 || text == ":") wrong_form(text, kForm);
  std::array<std::uint64_t, 2> window = {0, std::numeric_limits<std::uint64_t>::max()};
  for (std::size_t i = 0; i < 2; ++i) {
    if (ends[i].empty()) continue;
    const auto cycle = whole(ends[i]);
    if (!cycle) wrong_form(text, kForm);
    window[i] = *cycle;
  }
  if (window[0] >= window[1]) throw InputError(in_quotes(text) + " ends before it begins");
  return window;
}

std::uint64_t parse_file_size(const std::string& text, std::uint64_t least, std::uint64_t most) {
  std::string_view digits = text;
  const unsigned shift = take_unit(digits, "KMG");
  const auto number = whole(digits);
  if (!number) wrong_form(text, "a size like 512K, 64M, 1G or a number of bytes");
  if (*number > most >> shift || *number << shift < least)
    throw InputError(in_quotes(text) + " is out of range: " + bytes_text(least) + " to " + bytes_text(most) +
                     " are allowed");
  return *number << shift;
}

FollowTarget parse_follow(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma != std::string::npos) {
    const auto column = numbers(std::string_view(text).substr(0, comma), ':');
    const auto rest = numbers(std::string_view(text).substr(comma + 1), ':');
    if (column && rest && column->size() == 1 && rest->size() <= 2)
      return FollowedPixel{column->front(), rest->front(), rest->size() == 2 ? rest->back() : 0};
  } else if (const auto all = numbers(text, ':'); all && (all->size() == 2 || all->size() == 3)) {
    return FollowedShot{(*all)[0], (*all)[1], all->size() == 3 ? (*all)[2] : 0};
  }
  wrong_form(text,
             "a pixel (X,Y or X,Y:SAMPLE) or a point of a shot (SHOT:POINT or SHOT:POINT:DIRECTION), all counted "
             "from 0");
}

GdbEndpoint parse_gdb_place(const std::string& text) {
  if (text.find('/') != std::string::npos) return {0, 0, text};
  const auto port = whole(text);
  if (!port)
    wrong_form(text, "a TCP port like 1234, or a path with a / like /tmp/pes; or these with a PE, like 3:1234");
  return {0, static_cast<std::uint16_t>(in_range(text, *port, 0, std::numeric_limits<std::uint16_t>::max()))};
}

GdbEndpoint parse_gdb_endpoint(const std::string& text) {
  constexpr const char* kForm = "a PE and a TCP port like 3:1234, or a path with a / like 3:/tmp/pe3";
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) wrong_form(text, kForm);
  const unsigned pe = pe_number(text.substr(0, colon), kForm);
  const std::string place = text.substr(colon + 1);
  if (place.find('/') != std::string::npos) return {pe, 0, place};
  const auto port = whole(place);
  if (!port) wrong_form(text, kForm);
  return {pe, static_cast<std::uint16_t>(in_range(text, *port, 0, std::numeric_limits<std::uint16_t>::max()))};
}

std::array<double, 3> parse_vector(const std::string& text) {
  const auto parts = split(text, ',');
  if (parts.size() != 3) wrong_form(text, "three numbers like 1,2.5,-3");
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = real(parts[i]);
    if (!value) wrong_form(text, "three numbers like 1,2.5,-3");
    result[i] = *value;
  }
  return result;
}

std::optional<double> parse_length(const std::string& text) {
  if (text == "auto") return std::nullopt;
  const auto value = real(text);
  if (!value) wrong_form(text, "a length in scene units, or auto");
  if (*value <= 0) throw InputError(in_quotes(text) + " is out of range: a length is greater than 0");
  return value;
}

double parse_number(const std::string& text, double least, double most) {
  const auto value = real(text);
  if (!value) wrong_form(text, "a number");
  if (*value < least || *value > most)
    throw InputError(in_quotes(text) + " is out of range: " + significant(least, 6) + " to " + significant(most, 6) +
                     " are allowed");
  return *value;
}

double parse_link_fault(const std::string& text) {
  constexpr std::string_view kLink = "link:";
  if (!text.starts_with(kLink)) wrong_form(text, "of the form link:P, like link:0.01");
  return parse_number(text.substr(kLink.size()), 0, 0.5);
}

std::vector<double> parse_rates(const std::string& text) {
  std::vector<double> rates;
  for (const std::string_view part : split(text, ',')) {
    const std::string one(part);
    rates.push_back(parse_number(one, 0, 1));
    if (rates.back() == 0) throw InputError(in_quotes(one) + " is out of range: a rate is above 0 and at most 1");
  }
  return rates;
}

std::uint64_t parse_count(const std::string& text, std::uint64_t least, std::uint64_t most) {
  const bool negative = text.starts_with('-');
  const auto value = whole(std::string_view(text).substr(negative ? 1 : 0));
  if (!value) wrong_form(text, "a whole number");
  constexpr auto largest = std::numeric_limits<std::uint64_t>::max();  // also what `whole` has for more
  const bool too_long = *value == largest && text.substr(text.find_first_not_of('0')) != std::to_string(largest);
  if (negative || too_long || *value < least || *value > most)
    throw InputError(in_quotes(text) + " is out of range: " + std::to_string(least) + " to " + std::to_string(most) +
                     " are allowed");
  return *value;
}

Preset parse_preset(const std::string& text) {
  if (const auto preset = preset_named(text)) return *preset;
  throw UsageError(no_such_name(text, "no quality preset", {"draft", "normal", "fine"}));
}

LayerSet parse_layers(const std::string& text) {
  LayerSet set = 0;
  for (const auto& [name, plane] : kLayerNames) set |= protocol::plane_bit(plane);
  if (text == "all") return set;
  set = 0;
  for (const auto& part : split(text, ',')) {
    const auto* layer = std::ranges::find(kLayerNames, part, &LayerName::name);
    if (layer == kLayerNames.end()) {
      std::vector<std::string> names{"all"};
      for (const LayerName& one : kLayerNames) names.emplace_back(one.name);
      throw UsageError(no_such_name(part, "no layer", names));
    }
    set |= protocol::plane_bit(layer->plane);
  }
  return set;
}

MissingMaterials parse_missing_materials(const std::string& text) {
  if (text == "refuse") return MissingMaterials::refuse;
  if (text == "white") return MissingMaterials::white;
  throw UsageError(no_such_name(text, "nothing that is done with missing materials", {"refuse", "white"}));
}

GltfUnits parse_gltf_units(const std::string& text) {
  if (text == "watt") return GltfUnits::watt;
  if (text == "lumen") return GltfUnits::lumen;
  throw UsageError(no_such_name(text, "no unit of light of glTF files", {"watt", "lumen"}));
}

std::size_t parse_name(const std::string& text, std::span<const std::string_view> names, std::string_view kind) {
  const auto found = std::ranges::find(names, text);
  if (found == names.end()) throw UsageError(no_such_name(text, kind, {names.begin(), names.end()}));
  return static_cast<std::size_t>(found - names.begin());
}

std::optional<double> parse_fraction(const std::string& text) {
  if (text == "auto") return std::nullopt;
  return parse_number(text, 0, 1);
}

WhiteBalance parse_white_balance(const std::string& text) {
  if (text == "off") return {};
  if (text == "auto") return {WhiteBalance::Kind::automatic, 0};
  return {WhiteBalance::Kind::kelvin, parse_number(text, kLeastWhiteKelvin, kMostWhiteKelvin)};
}

}  // namespace torolux
