// SPDX-License-Identifier: MIT
// elfutils' libdw reads; here what it says becomes places and registers.
#include "emulator/engines/image/debug_info.hpp"

#include <cxxabi.h>
#include <dwarf.h>
#include <elfutils/libdw.h>

#include <cstdlib>
#include <filesystem>
#include <span>

namespace torolux {
namespace {

/// Functions inlined into each other at one place; more are not told.
constexpr int kMostPlaces = 32;

template <class Type>
using Freed = std::unique_ptr<Type, decltype(&std::free)>;

Freed<Dwarf_Frame> frame_at(Dwarf_CFI* rules, std::uint32_t address) {
  Dwarf_Frame* frame = nullptr;
  if (rules == nullptr || dwarf_cfi_addrframe(rules, address, &frame) != 0) frame = nullptr;
  return {frame, &std::free};
}

/// Of register number + offset: the one form that compilers write for a frame's address.
std::optional<std::uint32_t> frame_address(Dwarf_Frame* frame, const FrameRegisters& registers) {
  Dwarf_Op* operations = nullptr;
  std::size_t count = 0;
  if (dwarf_frame_cfa(frame, &operations, &count) != 0 || count != 1) return std::nullopt;
  const Dwarf_Op& operation = operations[0];
  const bool plain = operation.atom >= DW_OP_breg0 && operation.atom <= DW_OP_breg31;
  if (!plain && operation.atom != DW_OP_bregx) return std::nullopt;
  const Dwarf_Word number = plain ? operation.atom - Dwarf_Word{DW_OP_breg0} : operation.number;
  const Dwarf_Word offset = plain ? operation.number : operation.number2;
  if (number >= registers.x.size() || !registers.x[number]) return std::nullopt;
  return *registers.x[number] + static_cast<std::uint32_t>(offset);
}

/// A register of the caller: kept in its place, at a place of the frame, or unknown.
std::optional<std::uint32_t> callers_register(Dwarf_Frame* frame, unsigned number, const FrameRegisters& registers,
                                              std::uint32_t frame_address, const ReadWord& read) {
  std::array<Dwarf_Op, 3> buffer{};
  Dwarf_Op* operations = nullptr;
  std::size_t count = 0;
  if (dwarf_frame_register(frame, static_cast<int>(number), buffer.data(), &operations, &count) != 0)
    return std::nullopt;
  if (count == 0) return operations == nullptr ? registers.x[number] : std::nullopt;
  if (operations[0].atom != DW_OP_call_frame_cfa) return std::nullopt;
  std::uint32_t value = frame_address;
  for (const Dwarf_Op& operation : std::span(operations, count).subspan(1)) {
    if (operation.atom == DW_OP_stack_value) return value;
    if (operation.atom != DW_OP_plus_uconst) return std::nullopt;
    value += static_cast<std::uint32_t>(operation.number);
  }
  return read(value);
}

std::string text_of(const char* text) {
  return text == nullptr ? "" : text;
}

/// With namespaces and arguments, where the language has them.
std::string function_name(Dwarf_Die* function) {
  for (const unsigned name : {DW_AT_linkage_name, DW_AT_MIPS_linkage_name}) {
    Dwarf_Attribute attribute{};
    if (dwarf_attr_integrate(function, name, &attribute) == nullptr) continue;
    if (const std::string text = text_of(dwarf_formstring(&attribute)); !text.empty()) return demangled(text);
  }
  return text_of(dwarf_diename(function));
}

/// By what each unit says of itself: the file's table of addresses may be cut short, and then knows no unit at all.
bool find_unit(Dwarf* dwarf, std::uint32_t address, Dwarf_Die& unit) {
  Dwarf_CU* at = nullptr;
  while (dwarf_get_units(dwarf, at, &at, nullptr, nullptr, &unit, nullptr) == 0) {
    if (dwarf_haspc(&unit, address) == 1) return true;
  }
  return false;
}

/// Compilers name sources from the folder in which they ran.
std::string file_name(const char* name, Dwarf_Die* unit) {
  if (name == nullptr) return "";
  Dwarf_Attribute attribute{};
  const std::string folder = text_of(dwarf_formstring(dwarf_attr(unit, DW_AT_comp_dir, &attribute)));
  return (std::filesystem::path(folder) / name).lexically_normal().string();
}

/// Where what was inlined stands in the function around it.
void set_place_of_call(Dwarf_Die* inlined, Dwarf_Die* unit, SourcePlace& place) {
  Dwarf_Attribute attribute{};
  Dwarf_Word file = 0;
  Dwarf_Word line = 0;
  Dwarf_Files* files = nullptr;
  std::size_t count = 0;
  if (dwarf_formudata(dwarf_attr(inlined, DW_AT_call_file, &attribute), &file) != 0 ||
      dwarf_formudata(dwarf_attr(inlined, DW_AT_call_line, &attribute), &line) != 0 ||
      dwarf_getsrcfiles(unit, &files, &count) != 0 || file >= count) {
    place = {};
    return;
  }
  place.file = file_name(dwarf_filesrc(files, file, nullptr, nullptr), unit);
  place.line = static_cast<int>(line);
}

bool is_function(Dwarf_Die* die) {
  const int tag = dwarf_tag(die);
  return tag == DW_TAG_inlined_subroutine || tag == DW_TAG_subprogram;
}

}  // namespace

struct DebugInfo::Parts {
  explicit Parts(std::vector<std::byte> bytes) : contents(std::move(bytes)) {
    elf_version(EV_CURRENT);
    elf = elf_memory(reinterpret_cast<char*>(contents.data()), contents.size());
    if (elf == nullptr) return;
    dwarf = dwarf_begin_elf(elf, DWARF_C_READ, nullptr);
    if (dwarf != nullptr) rules = dwarf_getcfi(dwarf);
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  ~Parts() {
    if (dwarf != nullptr) dwarf_end(dwarf);
    if (elf != nullptr) elf_end(elf);
  }

  std::vector<std::byte> contents;
  Elf* elf = nullptr;
  Dwarf* dwarf = nullptr;      // of `elf`
  Dwarf_CFI* rules = nullptr;  // of `dwarf`
};

DebugInfo::DebugInfo(std::vector<std::byte> contents) : parts_(std::make_unique<Parts>(std::move(contents))) {}
DebugInfo::~DebugInfo() = default;

std::vector<SourcePlace> DebugInfo::places(std::uint32_t address) const {
  std::vector<SourcePlace> places;
  Dwarf_Die unit{};
  if (parts_->dwarf == nullptr || !find_unit(parts_->dwarf, address, unit)) return places;
  SourcePlace place;
  if (Dwarf_Line* line = dwarf_getsrc_die(&unit, address); line != nullptr && dwarf_lineno(line, &place.line) == 0)
    place.file = file_name(dwarf_linesrc(line, nullptr, nullptr), &unit);
  Dwarf_Die* found = nullptr;
  int count = dwarf_getscopes(&unit, address, &found);
  Freed<Dwarf_Die> scopes(found, &std::free);
  // These are the scopes of the source; what is inlined where is in those of the innermost function as it was compiled.
  for (int i = 0; i < count; ++i) {
    if (!is_function(&scopes.get()[i])) continue;
    Dwarf_Die innermost = scopes.get()[i];
    found = nullptr;
    count = dwarf_getscopes_die(&innermost, &found);
    scopes.reset(found);
    break;
  }
  for (int i = 0; i < count && places.size() < kMostPlaces; ++i) {
    Dwarf_Die* scope = &scopes.get()[i];
    if (!is_function(scope)) continue;
    place.function = function_name(scope);
    places.push_back(place);
    if (dwarf_tag(scope) == DW_TAG_subprogram) return places;
    set_place_of_call(scope, &unit, place);
  }
  if (places.empty() && !place.file.empty()) places.push_back(place);
  return places;
}

bool DebugInfo::knows_frame(std::uint32_t address) const {
  return frame_at(parts_->rules, address) != nullptr;
}

std::optional<FrameRegisters> DebugInfo::caller(const FrameRegisters& frame, std::uint32_t address,
                                                const ReadWord& read) const {
  const auto rules = frame_at(parts_->rules, address);
  if (rules == nullptr) return std::nullopt;
  const auto base = frame_address(rules.get(), frame);
  if (!base) return std::nullopt;
  FrameRegisters caller;
  for (unsigned number = 1; number < caller.x.size(); ++number)
    caller.x[number] = callers_register(rules.get(), number, frame, *base, read);
  caller.x[2] = base;
  bool signal = false;
  const int column = dwarf_frame_info(rules.get(), nullptr, nullptr, &signal);
  if (column < 1 || column >= static_cast<int>(caller.x.size())) return std::nullopt;
  const auto& back = caller.x[static_cast<std::size_t>(column)];
  if (!back) return std::nullopt;
  caller.pc = *back;
  return caller;
}

std::string demangled(const std::string& name) {
  if (!name.starts_with("_Z")) return name;  // the library takes `f` for the type float
  int status = 0;
  const Freed<char> text(abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status), &std::free);
  return status == 0 && text != nullptr ? std::string(text.get()) : name;
}

}  // namespace torolux
