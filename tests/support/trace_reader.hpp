// SPDX-License-Identifier: MIT
// Bytes of a trace enter; its tracks and events leave. Knows the format from its description, nothing of the writer.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace torolux::testing_support {

struct ReadTrack {
  std::string name, unit;
  std::uint64_t parent = 0;
  bool counter = false;
};

struct ReadEvent {
  enum Type : std::uint8_t { begin = 1, end = 2, instant = 3, counter = 4 };
  std::uint64_t time = 0, track = 0;  ///< [ns]
  Type type = begin;
  std::string name;
  double value = 0;
  std::vector<std::uint64_t> arrows, arrow_ends;
  std::map<std::string, std::string> annotations;
};

struct ReadTrace {
  std::map<std::uint64_t, ReadTrack> tracks;
  std::vector<ReadEvent> events;   ///< as they stand in the file
  std::vector<std::string> wrong;  ///< what a trace must not have

  /// The one with this name below that one; 0: there is none.
  std::uint64_t track(std::string_view name, std::uint64_t parent = 0) const;
  /// Of the slices of a track, by name [ns].
  std::map<std::string, std::uint64_t> lengths(std::uint64_t track) const;
  std::size_t arrows() const;
};

/// wrong: bytes that are no message, tracks and names that are used before they are made, times that fall on a track,
/// slices that overlap, are empty or have no end, arrows without both ends or that end before they begin.
ReadTrace read_trace(std::string_view bytes);

}  // namespace torolux::testing_support
