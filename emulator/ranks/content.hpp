// SPDX-License-Identifier: MIT
// What ranks of one program tell each other, to a message's bytes and back: by its function `archive`.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "emulator/snapshot/archive.hpp"

namespace torolux::ranks {

template <class Content>
std::vector<std::byte> bytes_of(Content content) {
  std::vector<std::byte> bytes;
  SnapshotWriter writer(
      [&bytes](std::span<const std::byte> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
  writer(content);
  writer.flush();
  return bytes;
}

/// Throws InputError where these are the bytes of something else.
template <class Content>
Content content_of(std::span<const std::byte> bytes) {
  Content content;
  SnapshotReader reader([&bytes](std::span<std::byte> into) {
    if (bytes.size() < into.size()) throw InputError("a message between ranks is too short");
    std::memcpy(into.data(), bytes.data(), into.size());
    bytes = bytes.subspan(into.size());
  });
  reader(content);
  if (!bytes.empty()) throw InputError("a message between ranks is too long");
  return content;
}

}  // namespace torolux::ranks
