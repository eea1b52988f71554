// SPDX-License-Identifier: MIT
// Records in, names out. No byte is believed before it has been checked.
#include "emulator/engines/image/phase_records.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace torolux {
namespace {

constexpr std::string_view kReserved = "outside";  // what statistics call the cycles in no phase
constexpr auto kProgram = static_cast<std::size_t>(protocol::Phase::program);

/// Bytes of the character that begins a text of UTF-8 (The Unicode Standard 15.0, table 3-7); 0: it is none, or a
/// control character.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [text](std::size_t i) -> unsigned {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
  };
  const auto follows = [byte](std::size_t i, unsigned least = 0x80, unsigned most = 0xBF) {
    return byte(i) >= least && byte(i) <= most;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  if (first == 0xC2) return follows(1, 0xA0) ? 2 : 0;  // below: control characters
  if (first > 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool good = follows(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF) && follows(2);
    return good ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool good = follows(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF) && follows(2) && follows(3);
    return good ? 4 : 0;
  }
  return 0;
}

bool is_text(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

std::uint32_t phase_of(std::span<const std::byte> record) {
  std::uint32_t phase = 0;
  std::memcpy(&phase, record.data(), sizeof phase);
  return phase;
}

/// Programs in C write another number: theirs begin behind those of Torolux (TOROLUX_FIRST_PHASE).
std::string in_c(std::uint32_t phase) {
  constexpr auto first = static_cast<std::uint32_t>(protocol::Phase::count);
  if (phase < first) return "";
  return "; in C it is TOROLUX_PHASE_NAME(" + std::to_string(phase - first) + ", ...), of 0 to " +
         std::to_string(protocol::kPhases - first - 1);
}

/// What is wrong with it; empty: nothing.
std::string put_record(std::span<const std::byte> record, PhaseNames& names) {
  const std::uint32_t phase = phase_of(record);
  const std::string what = "phase " + std::to_string(phase);
  if (phase >= protocol::kPhases) {
    return "names " + what + "; there are 0 to " + std::to_string(protocol::kPhases - 1);
  }
  const auto* const text = reinterpret_cast<const char*>(record.data() + sizeof phase);
  const char* const end = std::find(text, text + kMostPhaseNameBytes + 1, '\0');
  if (end == text + kMostPhaseNameBytes + 1) {
    return "has a name of " + what + " that is longer than " + std::to_string(kMostPhaseNameBytes) + " bytes";
  }
  const std::string name(text, end);
  if (name.empty()) return "has an empty name of " + what;
  if (!is_text(name)) return "has a name of " + what + " with control characters, or that is no UTF-8";
  if (name == kReserved) {
    return "names " + what + " \"" + name + "\", as statistics call the cycles in no phase: take another name";
  }
  if (!names[phase].empty()) return "names " + what + " twice: \"" + names[phase] + "\" and \"" + name + "\"";
  if (std::find(names.begin(), names.end(), name) != names.end()) return "calls two phases \"" + name + "\"";
  names[phase] = name;
  return "";
}

}  // namespace

PhaseRecords read_phase_records(std::span<const std::byte> section) {
  PhaseRecords result;
  if (section.size() % kPhaseRecordBytes != 0) {
    result.wrong = "has " + std::to_string(section.size()) + " bytes of phase names, which is no multiple of " +
                   std::to_string(kPhaseRecordBytes);
  }
  for (; result.wrong.empty() && !section.empty(); section = section.subspan(kPhaseRecordBytes)) {
    const auto record = section.first(kPhaseRecordBytes);
    result.wrong = put_record(record, result.names);
    if (!result.wrong.empty()) result.wrong += in_c(phase_of(record));
  }
  const std::string program = protocol::kPhaseNames[kProgram];
  const bool taken = std::find(result.names.begin(), result.names.end(), program) != result.names.end();
  if (result.names[kProgram].empty() && taken && result.wrong.empty()) {
    result.wrong = "calls a phase \"" + program + "\", as start-up code calls phase " + std::to_string(kProgram);
  }
  if (result.names[kProgram].empty()) result.names[kProgram] = program;
  return result;
}

}  // namespace torolux
