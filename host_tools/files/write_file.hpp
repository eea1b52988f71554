// SPDX-License-Identifier: MIT
// Files of the user: written whole or not at all, and read with a limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace torolux {

/// Writes `contents` to a temporary file in the same folder and renames it, so that `file` is never seen half written.
/// A link is followed. Devices, pipes and what our standard output or standard error is, a shell's log, are written to
/// directly. Throws InputError; leaves nothing then.
void write_file(const std::filesystem::path& file, std::span<const std::byte> contents);
void write_file(const std::filesystem::path& file, std::string_view text);

/// The same for contents that come piece by piece: nothing is kept in memory, and `file` is there once `finish` has
/// been called, not before. Without that, nothing is left. Throws InputError.
class FileWriter {
 public:
  explicit FileWriter(const std::filesystem::path& file);
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  ~FileWriter();
  void append(std::span<const std::byte> contents);
  /// At a place of its own; what lies between is zeros. To a device: behind what was written before.
  void write_at(std::uint64_t position, std::span<const std::byte> contents);
  /// All that was written so far is gone; not of a device.
  void empty();
  void finish();

 private:
  struct Parts;
  std::filesystem::path file_;
  std::unique_ptr<Parts> parts_;
};

/// Throws InputError where write_file would fail: no such folder, no right, `file` is a folder. For calling before
/// hours of work. Leaves nothing behind.
void check_file_writable(const std::filesystem::path& file);

/// A device or pipe: it must not be replaced by a file, and can be read only once.
bool is_device(const std::filesystem::path& file);

/// The whole file. Throws InputError: not found, not readable, a folder, larger than `most_bytes`.
std::vector<std::byte> read_file(const std::filesystem::path& file, std::size_t most_bytes);

}  // namespace torolux
