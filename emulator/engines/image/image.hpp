// SPDX-License-Identifier: MIT
// An ELF file for rv32imafc enters; a firmware image leaves, checked against what the machine asks of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "emulator/phase_names.hpp"

namespace torolux {

struct ImageSymbol {
  std::uint32_t address;
  std::uint32_t bytes;
  std::string name;
  bool function = false;  ///< by its type: code, `bytes` of it
};

struct ImageSegment {
  std::uint32_t address;
  std::uint32_t memory_bytes;  ///< >= contents.size(); the rest is zero
  std::vector<std::byte> contents;
  bool executable;
  bool writable;
};

struct Image {
  std::filesystem::path file;
  std::vector<ImageSegment> segments;
  std::vector<ImageSymbol> symbols;                 ///< functions and objects, ascending address
  std::uint32_t entry;                              ///< = kLocalMemoryBase
  std::uint32_t niu_window;                         ///< symbol __niu_window
  std::uint32_t stores_begin;                       ///< symbol __stores_begin: first byte that the image leaves free
  PhaseNames phase_names = built_in_phase_names();  ///< or those of its section .torolux.phases

  /// What the address lies in: by its size, or the last label before it. Null: nothing is near.
  const ImageSymbol* symbol_of(std::uint32_t address) const;
  /// "name+0x12", or the bare address where no symbol is near.
  std::string describe(std::uint32_t address) const;
  /// Copies all segments to local memory. Throws InputError where they do not fit (needed, available).
  void load_into(std::span<std::byte> local_memory) const;
};

/// The bytes of a file of reasonable size. Throws InputError.
std::vector<std::byte> read_image_file(const std::filesystem::path& file);
/// Throws InputError: not an ELF, wrong machine, entry not at kLocalMemoryBase, symbols missing, segments out of place.
Image load_image(const std::filesystem::path& file);
/// The same from the bytes of a file; `file` is for messages only.
Image parse_image(std::span<const std::byte> contents, const std::filesystem::path& file);

}  // namespace torolux
