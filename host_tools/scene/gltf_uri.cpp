// SPDX-License-Identifier: MIT
// Decodes the URIs of glTF files: data within (RFC 2397, base64 as in RFC 4648), and names of files (RFC 3986).
#include <algorithm>

#include "host_tools/scene/gltf_data.hpp"

namespace torolux {
namespace {

/// 0..63; 64: no letter of base64.
unsigned value_of_letter(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<unsigned>(c - 'A');
  if (c >= 'a' && c <= 'z') return static_cast<unsigned>(c - 'a') + 26;
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0') + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : 64;
}

std::string from_base64(std::string_view text, const Place& place) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  unsigned held = 0;
  unsigned bits = 0;
  for (const char c : text) {
    const unsigned value = value_of_letter(c);
    if (value == 64) refuse(place, "its data URI is not base64");
    held = (held << 6U | value) & 0xFFFFU;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<char>(held >> bits & 0xFFU));
  }
  return bytes;
}

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

std::string name_of_uri(std::string_view uri) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hexadecimal(uri[i + 1]) : -1;
    const int low = high >= 0 ? hexadecimal(uri[i + 2]) : -1;
    // A zero would end the name for whoever opens it.
    if (low < 0 || high * 16 + low == 0) {
      name.push_back(uri[i]);
      continue;
    }
    name.push_back(static_cast<char>(high * 16 + low));
    i += 2;
  }
  return name;
}

std::optional<std::string> bytes_of_data_uri(std::string_view uri, const Place& place) {
  if (!uri.starts_with("data:")) return std::nullopt;
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) refuse(place, "its data URI has no comma before its data");
  const std::string_view data = uri.substr(comma + 1);
  return uri.substr(0, comma).ends_with(";base64") ? from_base64(data, place) : name_of_uri(data);
}

}  // namespace torolux
