// SPDX-License-Identifier: MIT
// Compares files by where they are, whatever they are called.
#include "host_tools/files/distinct_files.hpp"

#include <map>
#include <system_error>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

namespace fs = std::filesystem;

/// Links followed, also to what is not there yet.
fs::path place_of(fs::path file) {
  std::error_code error;
  file = fs::absolute(file, error);
  constexpr int most_links = 40;  // as the kernel follows
  for (int links = 0; links < most_links && fs::is_symlink(file, error); ++links)
    file = file.parent_path() / fs::read_symlink(file, error);
  const fs::path whole = fs::weakly_canonical(file, error);
  return error ? file : whole;
}

}  // namespace

void check_distinct(std::span<const NamedFile> written, std::span<const NamedFile> read) {
  std::map<fs::path, std::string> known;
  for (const NamedFile& one : read) known.emplace(place_of(one.file), one.what);
  for (const NamedFile& one : written) {
    std::error_code error;
    const fs::file_status status = fs::status(one.file, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) continue;
    const auto [entry, fresh] = known.emplace(place_of(one.file), one.what);
    if (!fresh)
      throw InputError(one.what + " " + one.file.string() + ": this is " + entry->second +
                       ", too, and would be written over; name another file");
  }
}

}  // namespace torolux
