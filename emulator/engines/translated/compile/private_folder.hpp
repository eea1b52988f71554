// SPDX-License-Identifier: MIT
// A folder that nobody but its user can change, and its files. Enters: a path; leaves: the folder, or why it is not
// one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace torolux::translated {

/// An open file, closed with the object.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  OpenFile(OpenFile&& other) noexcept;
  OpenFile& operator=(OpenFile&&) = delete;
  ~OpenFile();
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

class PrivateFolder {
 public:
  /// Why a folder cannot be used.
  struct Refusal {
    bool untrusted;   ///< it is there, but others may change what is in it; false: it cannot be made or opened
    std::string why;  ///< names the folder that is to blame
  };

  /// Opens the folder; makes it, and what is missing above it, with mode 0700. It is taken where this process's user
  /// owns it and nobody else may write to it (then it gets mode 0700, too), and where each folder above it, symbolic
  /// links resolved, belongs to that user or to root and lets nobody else rename what is in it.
  static std::variant<PrivateFolder, Refusal> open(const std::filesystem::path& folder);

  /// The contents of a regular file that the user owns and nobody else may write to; nothing where there is no such
  /// file, or a symbolic link. name: without folders.
  std::optional<std::string> read(const std::string& name) const;

  /// From one moment to the next, with mode 0600. False where it cannot be written; then nothing is left behind.
  bool replace(const std::string& name, std::string_view contents) const;

 private:
  explicit PrivateFolder(OpenFile folder) : folder_(std::move(folder)) {}

  OpenFile folder_;
};

}  // namespace torolux::translated
