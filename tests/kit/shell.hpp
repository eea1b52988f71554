// SPDX-License-Identifier: MIT
// What a user types, in an empty folder of its own: lines for a shell in; exit code, output and errors out.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace torolux::test {

struct Said {
  int exit_code;
  std::string output, errors;
};

/// A folder far from the checkout, with a shell in which `torolux` is the program as built, or another one.
class UserFolder {
 public:
  /// program_folder: comes first in PATH; empty: where the build put torolux.
  explicit UserFolder(std::filesystem::path program_folder = {});

  const std::filesystem::path& path() const { return folder_.path(); }
  void write(const std::string& file, std::string_view text) const;
  /// bash -c, in the folder.
  Said run(const std::string& lines) const;
  /// The same, which must succeed; what it printed.
  std::string succeed(const std::string& lines) const;

 private:
  testing_support::TemporaryFolder folder_;
  std::filesystem::path program_folder_;
};

/// Runs the image on each engine, quietly: what it says must be the same on all, clocks and all, and so must the
/// figures of the PEs. Returns it. options: of `torolux run`.
std::string said_on_all_engines(const UserFolder& folder, const std::string& image, const std::string& options);

/// Lines "PE 3 @ 812: text", without number and clock: "text\n", sorted.
std::string texts_of(const std::string& output);

}  // namespace torolux::test
