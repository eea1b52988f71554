// SPDX-License-Identifier: MIT
// Puts ELF header, two segments, symbols and their names one behind the other.
#include "tests/unit/emulator/engines/elf_builder.hpp"

#include <elf.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

namespace torolux::test {
namespace {

constexpr const char* kPhases = ".torolux.phases";

template <class T>
void put(std::vector<std::byte>& file, const T& value) {
  file.resize(file.size() + sizeof(T));
  std::memcpy(file.data() + file.size() - sizeof(T), &value, sizeof(T));
}

Elf32_Word size32(std::size_t bytes) {
  return static_cast<Elf32_Word>(bytes);
}

Elf32_Ehdr make_header(const ElfPlan& plan, std::size_t sections_at) {
  Elf32_Ehdr header{};
  std::memcpy(header.e_ident, ELFMAG, SELFMAG);
  header.e_ident[EI_CLASS] = ELFCLASS32;
  header.e_ident[EI_DATA] = ELFDATA2LSB;
  header.e_ident[EI_VERSION] = EV_CURRENT;
  header.e_type = ET_EXEC;
  header.e_machine = EM_RISCV;
  header.e_version = EV_CURRENT;
  header.e_flags = EF_RISCV_RVC | EF_RISCV_FLOAT_ABI_SINGLE;
  header.e_entry = plan.entry;
  header.e_phoff = sizeof(Elf32_Ehdr);
  header.e_phentsize = sizeof(Elf32_Phdr);
  header.e_phnum = 2;
  header.e_shoff = size32(sections_at);
  header.e_shentsize = sizeof(Elf32_Shdr);
  header.e_shnum = plan.phases.empty() ? 3 : 5;
  header.e_shstrndx = plan.phases.empty() ? SHN_UNDEF : 4;
  header.e_ehsize = sizeof(Elf32_Ehdr);
  return header;
}

Elf32_Shdr make_section(Elf32_Word type, std::size_t offset, std::size_t bytes, Elf32_Word link) {
  Elf32_Shdr section{};
  section.sh_type = type;
  section.sh_offset = size32(offset);
  section.sh_size = size32(bytes);
  section.sh_link = link;
  return section;
}

}  // namespace

std::vector<std::byte> build_elf(const ElfPlan& plan) {
  const Elf32_Word code_bytes = size32(plan.code.size() * sizeof(std::uint32_t));
  const Elf32_Addr data = plan.data_address != 0 ? plan.data_address : 0x8000'0000U + (code_bytes + 4095) / 4096 * 4096;
  const Elf32_Addr window = plan.window != 0 ? plan.window : data;
  const Elf32_Addr stores = plan.stores_begin != 0 ? plan.stores_begin : data + plan.data_bytes;

  std::string names(1, '\0');
  std::vector<Elf32_Sym> symbols(1);
  const auto add_symbol = [&](const BuiltSymbol& symbol) {
    symbols.push_back({size32(names.size()), symbol.address, symbol.bytes, ELF32_ST_INFO(STB_GLOBAL, STT_FUNC), 0, 1});
    names += symbol.name + '\0';
  };
  if (plan.name_window) add_symbol({"__niu_window", window, 0});
  if (plan.name_stores) add_symbol({"__stores_begin", stores, 0});
  for (const BuiltSymbol& symbol : plan.symbols) add_symbol(symbol);

  const std::size_t code_at = sizeof(Elf32_Ehdr) + 2 * sizeof(Elf32_Phdr);
  const std::size_t symbols_at = code_at + code_bytes;
  const std::size_t names_at = symbols_at + symbols.size() * sizeof(Elf32_Sym);
  const std::size_t phases_at = names_at + names.size();
  const std::size_t section_names_at = phases_at + plan.phases.size();
  const std::string section_names = plan.phases.empty() ? "" : std::string(1, '\0') + kPhases + '\0';
  std::vector<std::byte> file;
  put(file, make_header(plan, section_names_at + section_names.size()));
  put(file, Elf32_Phdr{PT_LOAD, size32(code_at), plan.code_address, plan.code_address, code_bytes, code_bytes,
                       plan.code_flags, 4});
  put(file, Elf32_Phdr{PT_LOAD, size32(symbols_at), data, data, 0, plan.data_bytes, plan.data_flags, 4096});
  for (const std::uint32_t word : plan.code) put(file, word);
  for (const Elf32_Sym& symbol : symbols) put(file, symbol);
  for (const char c : names) put(file, c);
  file.insert(file.end(), plan.phases.begin(), plan.phases.end());
  for (const char c : section_names) put(file, c);
  put(file, make_section(SHT_NULL, 0, 0, 0));
  put(file, make_section(SHT_SYMTAB, symbols_at, symbols.size() * sizeof(Elf32_Sym), 2));
  put(file, make_section(SHT_STRTAB, names_at, names.size(), 0));
  if (plan.phases.empty()) return file;
  Elf32_Shdr phases = make_section(SHT_PROGBITS, phases_at, plan.phases.size(), 0);
  phases.sh_name = 1;
  put(file, phases);
  put(file, make_section(SHT_STRTAB, section_names_at, section_names.size(), 0));
  return file;
}

TemporaryFile::TemporaryFile(const std::string& name, const std::vector<std::byte>& contents)
    : path_(std::filesystem::temp_directory_path() / ("torolux-" + std::to_string(getpid()) + "-" + name)) {
  std::ofstream stream(path_, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(contents.data()), static_cast<std::streamsize>(contents.size()));
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace torolux::test
