// SPDX-License-Identifier: MIT
// What ranks of one program tell each other, to a message's bytes and back: by its function `archive`.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "emulator/snapshot/archive.hpp"

namespace torolux::ranks {

/// write: is given a SnapshotWriter.
template <class Write>
std::vector<std::byte> bytes_of_archive(Write write) {
  std::vector<std::byte> bytes;
  SnapshotWriter writer(
      [&bytes](std::span<const std::byte> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
  write(writer);
  writer.flush();
  return bytes;
}

/// read: is given a SnapshotReader, and takes all of it. Throws InputError where these are the bytes of something else.
template <class Read>
void read_archive(std::span<const std::byte> bytes, Read read) {
  SnapshotReader reader([&bytes](std::span<std::byte> into) {
    if (bytes.size() < into.size()) throw InputError("a message between ranks is too short");
    std::memcpy(into.data(), bytes.data(), into.size());
    bytes = bytes.subspan(into.size());
  });
  read(reader);
  if (!bytes.empty()) throw InputError("a message between ranks is too long");
}

template <class Content>
std::vector<std::byte> bytes_of(Content content) {
  return bytes_of_archive([&content](SnapshotWriter& writer) { writer(content); });
}

/// Throws InputError where these are the bytes of something else.
template <class Content>
Content content_of(std::span<const std::byte> bytes) {
  Content content;
  read_archive(bytes, [&content](SnapshotReader& reader) { reader(content); });
  return content;
}

}  // namespace torolux::ranks
