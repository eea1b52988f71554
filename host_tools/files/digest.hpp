// SPDX-License-Identifier: MIT
// Bytes or files in; their SHA-256, as 64 hexadecimal digits, out.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace torolux {

/// Takes bytes piece by piece.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::span<const std::byte> bytes);
  /// Of all bytes so far. Once.
  std::string hexadecimal();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

std::string sha256(std::string_view text);
/// Throws InputError where the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

/// A file that a run takes in, and what was in it.
struct InputFile {
  std::string role;  ///< "scene", "radiosity", "image" or "firmware"
  std::string path;  ///< as it was named
  std::string sha256;

  bool operator==(const InputFile&) const = default;
};

}  // namespace torolux
