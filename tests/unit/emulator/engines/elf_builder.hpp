// SPDX-License-Identifier: MIT
// Small images made by hand for tests: instruction words in, the bytes of an ELF file out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace torolux::test {

/// A symbol of the image to be built.
struct BuiltSymbol {
  std::string name;
  std::uint32_t address;
  std::uint32_t bytes;
};

/// What the ELF shall say; the defaults are an image that the loader takes. Fields are there to be spoiled.
struct ElfPlan {
  std::vector<std::uint32_t> code;  ///< from kLocalMemoryBase
  std::uint32_t entry = 0x8000'0000U;
  std::uint32_t code_address = 0x8000'0000U;
  std::uint32_t code_flags = 5;     ///< PF_R | PF_X
  std::uint32_t data_address = 0;   ///< 0: the page behind the code
  std::uint32_t data_bytes = 4096;  ///< in memory; holds the NIU window
  std::uint32_t data_flags = 6;     ///< PF_R | PF_W
  std::uint32_t window = 0;         ///< 0: at data_address
  std::uint32_t stores_begin = 0;   ///< 0: behind the data
  bool name_window = true, name_stores = true;
  std::vector<BuiltSymbol> symbols;
  std::vector<std::byte> phases = {};  ///< contents of .torolux.phases; empty: no such section, and no sections' names
};

std::vector<std::byte> build_elf(const ElfPlan& plan);

/// A file in the test's temporary folder, removed at the end.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::vector<std::byte>& contents);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace torolux::test
