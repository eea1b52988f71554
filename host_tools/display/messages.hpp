// SPDX-License-Identifier: MIT
// What the display's server tells a page: types and contents enter, bytes leave. docs/display.md describes them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace torolux {

/// Of the messages; the page's are in host_tools/web/display/feed.js. What is older than the page must not be moved.
enum class MessageType : std::uint32_t {
  alive,     ///< nothing has happened for a while
  machine,   ///< JSON: what runs
  picture,   ///< JSON: another picture begins, black
  pixels,    ///< of it
  loads,     ///< of PEs and links
  texts,     ///< JSON: lines that PEs have said
  progress,  ///< JSON
  bye,       ///< JSON: the server ends, and why
  camera,    ///< JSON: from where the picture is seen
  packets,   ///< where each packet is, while the run is held back (pace.hpp)
  count
};

/// Little endian.
struct MessageHeader {
  std::uint32_t type;
  std::uint32_t bytes;  ///< of what follows
};
static_assert(sizeof(MessageHeader) == 8);

/// Begins `pixels`: `count` pixels in the order of rows follow, three floats each (R, G, B).
struct PixelsHeader {
  std::uint32_t first;
  std::uint32_t count;
};

/// Begins `loads`. Then, for each PE a byte, 255 for all of the time: its load; its phase (by number; 255: it was not
/// busy); and two bytes, 65535 for all of the time: the use of its outgoing links, those to the east of all PEs
/// first, then west, south, north.
struct LoadsHeader {
  std::uint64_t now;  ///< virtual time [cycles]
  std::uint64_t pixels_added;
  std::uint32_t torus_packets;
  std::uint32_t pes;
};
static_assert(sizeof(LoadsHeader) == 24);

/// Appends a message to `out`.
void append_message(std::string& out, MessageType type, std::string_view contents);

template <class T>
void append_bytes(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace torolux
