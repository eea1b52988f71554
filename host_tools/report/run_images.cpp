// SPDX-License-Identifier: MIT
// Files and PEs enter, lists and titles leave.
#include "host_tools/report/run_images.hpp"

#include <filesystem>

namespace torolux {
namespace {

template <class Name>
std::string joined(const std::vector<InputFile>& files, Name name) {
  std::string text;
  for (const InputFile& file : files) text += (text.empty() ? "" : ", ") + name(file);
  return text;
}

}  // namespace

std::vector<unsigned> RunImages::pes_of(std::uint32_t file) const {
  std::vector<unsigned> pes;
  for (unsigned pe = 0; pe < file_of_pe.size(); ++pe) {
    if (file_of_pe[pe] == file) pes.push_back(pe);
  }
  return pes;
}

std::string RunImages::paths() const {
  return joined(files, [](const InputFile& file) { return file.path; });
}

std::string RunImages::names() const {
  return joined(files, [](const InputFile& file) { return std::filesystem::path(file.path).filename().string(); });
}

}  // namespace torolux
