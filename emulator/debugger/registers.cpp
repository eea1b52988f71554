// SPDX-License-Identifier: MIT
// A table for each feature; numbers count through them.
#include "emulator/debugger/registers.hpp"

#include <array>

#include "emulator/debugger/words.hpp"

namespace torolux::debugger {
namespace {

constexpr std::array<std::string_view, 33> kIntegerNames = {
    "zero", "ra", "sp", "gp", "tp", "t0", "t1", "t2", "fp", "s1",  "a0",  "a1", "a2", "a3", "a4", "a5", "a6",
    "a7",   "s2", "s3", "s4", "s5", "s6", "s7", "s8", "s9", "s10", "s11", "t3", "t4", "t5", "t6", "pc"};
constexpr std::array<std::string_view, 32> kFloatNames = {
    "ft0", "ft1", "ft2", "ft3", "ft4", "ft5", "ft6", "ft7", "fs0", "fs1", "fa0",  "fa1",  "fa2", "fa3", "fa4",  "fa5",
    "fa6", "fa7", "fs2", "fs3", "fs4", "fs5", "fs6", "fs7", "fs8", "fs9", "fs10", "fs11", "ft8", "ft9", "ft10", "ft11"};
static_assert(kIntegerNames.size() + kFloatNames.size() == kGeneralRegisters);

struct Named {
  std::string_view name;
  std::uint32_t PeRegisters::*value;
};
constexpr unsigned kFflags = kGeneralRegisters, kFrm = kFflags + 1, kFcsr = kFrm + 1;
constexpr unsigned kFrmShift = 5, kFflagsMask = 31, kFrmMask = 7;
constexpr unsigned kFirstControl = kFcsr + 1;
constexpr std::array<Named, 9> kControl = {{{"mstatus", &PeRegisters::mstatus},
                                            {"mstatush", &PeRegisters::mstatush},
                                            {"mtvec", &PeRegisters::mtvec},
                                            {"mscratch", &PeRegisters::mscratch},
                                            {"mepc", &PeRegisters::mepc},
                                            {"mcause", &PeRegisters::mcause},
                                            {"mtval", &PeRegisters::mtval},
                                            {"mie", &PeRegisters::mie},
                                            {"mip", &PeRegisters::mip}}};
constexpr unsigned kClock = kFirstControl + kControl.size(), kInstructions = kClock + 1;

std::string entry(std::string_view name, unsigned number, unsigned bits, std::string_view type) {
  return "<reg name=\"" + std::string(name) + "\" bitsize=\"" + std::to_string(bits) + "\" type=\"" +
         std::string(type) + "\" regnum=\"" + std::to_string(number) + "\"/>\n";
}

std::string feature(std::string_view name, const std::string& entries) {
  return "<feature name=\"" + std::string(name) + "\">\n" + entries + "</feature>\n";
}

/// Null: it is none of those that have a place of 32 bits of their own.
template <class Registers>
auto* place_of(Registers& registers, unsigned number) {
  decltype(&registers.pc) place = nullptr;
  if (number < kPcNumber) place = &registers.x[number];
  if (number == kPcNumber) place = &registers.pc;
  if (number > kPcNumber && number < kGeneralRegisters) place = &registers.f[number - kPcNumber - 1];
  if (number == kFflags) place = &registers.fflags;
  if (number == kFrm) place = &registers.frm;
  if (number >= kFirstControl && number < kClock) place = &(registers.*kControl[number - kFirstControl].value);
  return place;
}

}  // namespace

std::string target_description() {
  std::string integers, floats, controls;
  for (unsigned i = 0; i < kIntegerNames.size(); ++i) {
    const std::string_view type = i == kPcNumber || i == 1 ? "code_ptr" : i >= 2 && i <= 4 ? "data_ptr" : "int";
    integers += entry(kIntegerNames[i], i, 32, type);
  }
  for (unsigned i = 0; i < kFloatNames.size(); ++i)
    floats += entry(kFloatNames[i], kPcNumber + 1 + i, 32, "ieee_single");
  floats += entry("fflags", kFflags, 32, "int") + entry("frm", kFrm, 32, "int") + entry("fcsr", kFcsr, 32, "int");
  for (unsigned i = 0; i < kControl.size(); ++i) controls += entry(kControl[i].name, kFirstControl + i, 32, "int");
  return "<?xml version=\"1.0\"?>\n<!DOCTYPE target SYSTEM \"gdb-target.dtd\">\n<target>\n"
         "<architecture>riscv:rv32</architecture>\n" +
         feature("org.gnu.gdb.riscv.cpu", integers) + feature("org.gnu.gdb.riscv.fpu", floats) +
         feature("org.gnu.gdb.riscv.csr", controls) +
         feature("org.torolux.pe",
                 entry("clock", kClock, 64, "uint64") + entry("instructions", kInstructions, 64, "uint64")) +
         "</target>\n";
}

std::optional<std::string> register_text(const PeRegisters& registers, unsigned number) {
  constexpr unsigned kBytes = 4, kWideBytes = 8;
  if (const auto* const place = place_of(registers, number)) return hex_of_register(*place, kBytes);
  if (number == kFcsr) return hex_of_register(registers.frm << kFrmShift | registers.fflags, kBytes);
  if (number == kClock) return hex_of_register(registers.clock, kWideBytes);
  if (number == kInstructions) return hex_of_register(registers.instructions, kWideBytes);
  return std::nullopt;
}

bool set_register(PeRegisters& registers, unsigned number, std::string_view text) {
  const auto value = register_in(text);
  if (!value) return false;
  if (number == kFcsr) {
    registers.fflags = *value & kFflagsMask;
    registers.frm = *value >> kFrmShift & kFrmMask;
    return true;
  }
  auto* const place = place_of(registers, number);
  if (place == nullptr) return false;
  const std::uint32_t mask = number == kFflags ? kFflagsMask : number == kFrm ? kFrmMask : ~0U;
  *place = number == 0 ? 0 : *value & (number == kPcNumber ? ~1U : mask);
  return true;
}

}  // namespace torolux::debugger
