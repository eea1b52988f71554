// SPDX-License-Identifier: MIT
// An ELF file in, a checked image out. No field of the file is believed before it has been checked.
#include "emulator/engines/image/image.hpp"

#include <elf.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>

#include "emulator/engines/image/debug_info.hpp"
#include "emulator/engines/image/phase_records.hpp"
#include "emulator/errors.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {
namespace {

using protocol::kLargestLocalMemory;
using protocol::kLocalMemoryBase;
using protocol::kPageBytes;

constexpr std::uint64_t kMostFileBytes = 256U << 20U;
constexpr std::uint64_t kMemoryEnd = std::uint64_t{kLocalMemoryBase} + kLargestLocalMemory;

std::string hexadecimal(std::uint64_t value) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string digits;
  do {
    digits.insert(digits.begin(), kDigits[value % 16]);
    value /= 16;
  } while (value != 0);
  return "0x" + digits;
}

/// The file's bytes, with every access checked.
class ElfReader {
 public:
  ElfReader(std::span<const std::byte> contents, const std::filesystem::path& file)
      : file_(file), contents_(contents) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file_.string() + ": " + what + ". A PE's image is an ELF file for rv32imafc/ilp32f; see " +
                     "docs/writing_firmware.md");
  }

  std::span<const std::byte> bytes(std::uint64_t offset, std::uint64_t count, const char* what) const {
    if (offset > contents_.size() || count > contents_.size() - offset) {
      fail(std::string("ends before its ") + what);
    }
    return contents_.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(count));
  }

  template <class T>
  T at(std::uint64_t offset, const char* what) const {
    T value;
    std::memcpy(&value, bytes(offset, sizeof(T), what).data(), sizeof(T));
    return value;
  }

 private:
  const std::filesystem::path& file_;
  std::span<const std::byte> contents_;
};

Elf32_Ehdr read_header(const ElfReader& reader) {
  const auto header = reader.at<Elf32_Ehdr>(0, "ELF header");
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) {
    reader.fail("is not an ELF file");
  }
  if (header.e_ident[EI_CLASS] != ELFCLASS32 || header.e_ident[EI_DATA] != ELFDATA2LSB ||
      header.e_machine != EM_RISCV) {
    reader.fail("is not for 32-bit little-endian RISC-V");
  }
  if (header.e_type != ET_EXEC) {
    reader.fail("is not a linked executable (ELF type " + std::to_string(header.e_type) + ", needed 2)");
  }
  const Elf32_Word float_abi = header.e_flags & EF_RISCV_FLOAT_ABI;
  if (float_abi == EF_RISCV_FLOAT_ABI_DOUBLE || float_abi == EF_RISCV_FLOAT_ABI_QUAD) {
    reader.fail("uses floating point wider than the PE's registers");
  }
  if (header.e_entry != kLocalMemoryBase) {
    reader.fail("starts at " + hexadecimal(header.e_entry) + "; a PE starts at " + hexadecimal(kLocalMemoryBase) +
                ": link _start there");
  }
  return header;
}

std::vector<ImageSegment> read_segments(const ElfReader& reader, const Elf32_Ehdr& header) {
  if (header.e_phnum != 0 && header.e_phentsize != sizeof(Elf32_Phdr)) {
    reader.fail("has program headers of " + std::to_string(header.e_phentsize) + " bytes, expected 32");
  }
  std::vector<ImageSegment> segments;
  for (std::uint64_t i = 0; i < header.e_phnum; ++i) {
    const auto segment = reader.at<Elf32_Phdr>(header.e_phoff + i * sizeof(Elf32_Phdr), "program headers");
    if (segment.p_type != PT_LOAD || segment.p_memsz == 0) {
      continue;
    }
    if (segment.p_filesz > segment.p_memsz) {
      reader.fail("has a segment that is larger in the file than in memory");
    }
    if (segment.p_vaddr < kLocalMemoryBase || std::uint64_t{segment.p_vaddr} + segment.p_memsz > kMemoryEnd) {
      reader.fail("has a segment at " + hexadecimal(segment.p_vaddr) + ", " + std::to_string(segment.p_memsz) +
                  " bytes: outside local memory, " + hexadecimal(kLocalMemoryBase) + " to at most " +
                  hexadecimal(kMemoryEnd));
    }
    const auto contents = reader.bytes(segment.p_offset, segment.p_filesz, "segments");
    segments.push_back({segment.p_vaddr,
                        segment.p_memsz,
                        {contents.begin(), contents.end()},
                        (segment.p_flags & PF_X) != 0,
                        (segment.p_flags & PF_W) != 0});
  }
  std::sort(segments.begin(), segments.end(),
            [](const ImageSegment& a, const ImageSegment& b) { return a.address < b.address; });
  return segments;
}

void check_segments(const ElfReader& reader, const std::vector<ImageSegment>& segments) {
  if (segments.empty() || segments.front().address != kLocalMemoryBase || !segments.front().executable) {
    reader.fail("has no code at " + hexadecimal(kLocalMemoryBase));
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const ImageSegment& segment = segments[i];
    if (segment.executable && segment.writable) {
      reader.fail("has a segment at " + hexadecimal(segment.address) +
                  " that is both code and writable: separate them in the linker script");
    }
    if (i + 1 == segments.size()) {
      continue;
    }
    const ImageSegment& next = segments[i + 1];
    const std::uint64_t end = std::uint64_t{segment.address} + segment.memory_bytes;
    if (end > next.address) {
      reader.fail("has segments that overlap at " + hexadecimal(next.address));
    }
    const bool same_page = (end - 1) / kPageBytes == next.address / kPageBytes;
    if (same_page && ((segment.executable && next.writable) || (segment.writable && next.executable))) {
      reader.fail("has code and writable data on one page at " + hexadecimal(next.address) +
                  ": start them on separate pages of " + std::to_string(kPageBytes) + " bytes");
    }
  }
}

/// The name at `offset` of a string table, or nothing where it does not end inside the table (or within reason).
std::optional<std::string> name_at(std::span<const std::byte> strings, std::uint32_t offset) {
  if (offset >= strings.size()) {
    return std::nullopt;
  }
  constexpr std::ptrdiff_t kLongest = 4096;
  const auto from = strings.begin() + offset;
  const auto limit = strings.end() - from < kLongest ? strings.end() : from + kLongest;
  const auto end = std::find(from, limit, std::byte{0});
  if (end == limit) {
    return std::nullopt;
  }
  std::string name(static_cast<std::size_t>(end - from), '\0');
  std::transform(from, end, name.begin(), [](std::byte b) { return static_cast<char>(b); });
  return name;
}

/// Of the section with the image's own phases; where it has none, those of Torolux.
PhaseNames read_phases(const ElfReader& reader, const Elf32_Ehdr& header) {
  const auto section_at = [&](std::uint64_t number) {
    return reader.at<Elf32_Shdr>(header.e_shoff + number * sizeof(Elf32_Shdr), "section headers");
  };
  if (header.e_shstrndx == SHN_UNDEF || header.e_shstrndx >= header.e_shnum) return built_in_phase_names();
  const Elf32_Shdr table = section_at(header.e_shstrndx);
  const auto names = reader.bytes(table.sh_offset, table.sh_size, "section names");
  for (std::uint64_t i = 0; i < header.e_shnum; ++i) {
    const Elf32_Shdr section = section_at(i);
    if (section.sh_type == SHT_NOBITS || name_at(names, section.sh_name) != kPhaseSection) continue;
    PhaseRecords records = read_phase_records(reader.bytes(section.sh_offset, section.sh_size, "phase names"));
    if (!records.wrong.empty()) reader.fail(records.wrong);
    return std::move(records.names);
  }
  return built_in_phase_names();
}

/// Every named symbol that has an address, functions and objects as well as labels of assembly and linker scripts.
std::vector<ImageSymbol> read_symbols(const ElfReader& reader, const Elf32_Ehdr& header) {
  if (header.e_shnum != 0 && header.e_shentsize != sizeof(Elf32_Shdr)) {
    reader.fail("has section headers of " + std::to_string(header.e_shentsize) + " bytes, expected 40");
  }
  // All of them are asked for, needed or not: they stand at the end, where a file that was cut off shows it.
  reader.bytes(header.e_shoff, std::uint64_t{header.e_shnum} * sizeof(Elf32_Shdr), "section headers");
  const auto section_at = [&](std::uint64_t number) {
    if (number >= header.e_shnum) {
      reader.fail("names section " + std::to_string(number) + ", which it does not have");
    }
    return reader.at<Elf32_Shdr>(header.e_shoff + number * sizeof(Elf32_Shdr), "section headers");
  };
  std::vector<ImageSymbol> symbols;
  for (std::uint64_t i = 0; i < header.e_shnum; ++i) {
    const Elf32_Shdr table = section_at(i);
    if (table.sh_type != SHT_SYMTAB) {
      continue;  // an ELF file has at most one of these
    }
    const Elf32_Shdr names = section_at(table.sh_link);
    const auto strings = reader.bytes(names.sh_offset, names.sh_size, "symbol names");
    const std::uint64_t count = table.sh_size / sizeof(Elf32_Sym);
    reader.bytes(table.sh_offset, table.sh_size, "symbols");
    for (std::uint64_t s = 0; s < count; ++s) {
      const auto symbol = reader.at<Elf32_Sym>(table.sh_offset + s * sizeof(Elf32_Sym), "symbols");
      const auto type = ELF32_ST_TYPE(symbol.st_info);
      const bool wanted = type == STT_FUNC || type == STT_OBJECT || type == STT_NOTYPE;
      auto name = name_at(strings, symbol.st_name);
      if (!wanted || symbol.st_shndx == SHN_UNDEF || !name || name->empty() || name->front() == '$' ||
          name->starts_with(".L")) {
        continue;
      }
      symbols.push_back({symbol.st_value, symbol.st_size, std::move(*name), type == STT_FUNC});
    }
    break;
  }
  return symbols;
}

std::uint32_t required_symbol(const ElfReader& reader, const std::vector<ImageSymbol>& symbols, std::string_view name) {
  const auto found =
      std::find_if(symbols.begin(), symbols.end(), [&](const ImageSymbol& symbol) { return symbol.name == name; });
  if (found == symbols.end()) {
    reader.fail("has no symbol " + std::string(name) + ": use the linker scripts in linker/, and do not strip it");
  }
  return found->address;
}

/// Only what lies in local memory can help to describe an address; one symbol for each address, sized ones first.
void tidy_symbols(std::vector<ImageSymbol>& symbols) {
  std::erase_if(symbols, [](const ImageSymbol& symbol) {
    return symbol.address < kLocalMemoryBase || symbol.address >= kMemoryEnd;
  });
  std::sort(symbols.begin(), symbols.end(), [](const ImageSymbol& a, const ImageSymbol& b) {
    return a.address != b.address ? a.address < b.address : a.bytes != b.bytes ? a.bytes > b.bytes : a.name < b.name;
  });
  const auto same = [](const ImageSymbol& a, const ImageSymbol& b) { return a.address == b.address; };
  symbols.erase(std::unique(symbols.begin(), symbols.end(), same), symbols.end());
}

void check_places(const ElfReader& reader, const Image& image) {
  const std::uint64_t window_end = std::uint64_t{image.niu_window} + kPageBytes;
  if (image.niu_window % kPageBytes != 0 || image.niu_window < kLocalMemoryBase || window_end > image.stores_begin) {
    reader.fail("has its NIU window at " + hexadecimal(image.niu_window) + ": it must be a whole page of local memory" +
                " before __stores_begin (" + hexadecimal(image.stores_begin) + ")");
  }
  for (const ImageSegment& segment : image.segments) {
    const std::uint64_t end = std::uint64_t{segment.address} + segment.memory_bytes;
    if (end > image.stores_begin) {
      reader.fail("has a segment that ends at " + hexadecimal(end) + ", behind __stores_begin (" +
                  hexadecimal(image.stores_begin) + ")");
    }
    if (!segment.writable && segment.address < window_end && end > image.niu_window) {
      reader.fail("has its NIU window in a segment that is not writable");
    }
  }
}

}  // namespace

std::vector<std::byte> read_image_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw InputError(file.string() + ": there is no such file");
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const std::streamoff bytes = stream ? static_cast<std::streamoff>(stream.tellg()) : -1;
  if (bytes < 0 || std::filesystem::is_directory(file, error)) {
    throw InputError(file.string() + ": the firmware image cannot be read");
  }
  if (static_cast<std::uint64_t>(bytes) > kMostFileBytes) {
    throw InputError(file.string() + ": larger than any firmware image (" + std::to_string(kMostFileBytes >> 20U) +
                     " MiB)");
  }
  std::vector<std::byte> contents(static_cast<std::size_t>(bytes));
  stream.seekg(0);
  if (!stream.read(reinterpret_cast<char*>(contents.data()), bytes)) {
    throw InputError(file.string() + ": the firmware image cannot be read");
  }
  return contents;
}

Image load_image(const std::filesystem::path& file) {
  return parse_image(read_image_file(file), file);
}

Image parse_image(std::span<const std::byte> contents, const std::filesystem::path& file) {
  const ElfReader reader(contents, file);
  const Elf32_Ehdr header = read_header(reader);
  Image image;
  image.file = file;
  image.entry = header.e_entry;
  image.segments = read_segments(reader, header);
  check_segments(reader, image.segments);
  image.symbols = read_symbols(reader, header);
  image.phase_names = read_phases(reader, header);
  image.niu_window = required_symbol(reader, image.symbols, "__niu_window");
  image.stores_begin = required_symbol(reader, image.symbols, "__stores_begin");
  tidy_symbols(image.symbols);
  check_places(reader, image);
  return image;
}

const ImageSymbol* Image::symbol_of(std::uint32_t address) const {
  constexpr std::uint32_t kNear = 4096;  // a label without a size speaks for this many bytes behind it
  const ImageSymbol* label = nullptr;
  for (const ImageSymbol& symbol : symbols) {
    if (symbol.address > address) break;
    const std::uint32_t distance = address - symbol.address;
    if (distance < symbol.bytes) return &symbol;
    if (symbol.bytes == 0 && distance < kNear) label = &symbol;
  }
  return label;
}

std::string Image::describe(std::uint32_t address) const {
  const ImageSymbol* const symbol = symbol_of(address);
  if (symbol == nullptr) return hexadecimal(address);
  const std::uint32_t distance = address - symbol->address;
  return demangled(symbol->name) + (distance == 0 ? "" : "+" + hexadecimal(distance));
}

void Image::load_into(std::span<std::byte> local_memory) const {
  const std::uint64_t needed = std::uint64_t{stores_begin} - kLocalMemoryBase;
  if (needed > local_memory.size()) {
    throw InputError(file.string() + ": needs " + std::to_string(needed) + " bytes of local memory, a PE has " +
                     std::to_string(local_memory.size()) + ": give it more (--pe-memory)");
  }
  for (const ImageSegment& segment : segments) {
    const auto place = local_memory.subspan(segment.address - kLocalMemoryBase, segment.memory_bytes);
    std::fill(std::copy(segment.contents.begin(), segment.contents.end(), place.begin()), place.end(), std::byte{0});
  }
}

}  // namespace torolux
