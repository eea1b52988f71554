// SPDX-License-Identifier: MIT
// Start-up in C++. Enters: a stack and the NIU window; leaves: local memory locked to its rights, the protocol's
// version checked, and the program running with its NIU driver.
#include "firmware/boot/boot.hpp"

#include <cstdint>

#include "firmware/protocol/hints.hpp"
#include "firmware/protocol/machine.hpp"

extern "C" {
extern torolux::pe::NiuPage image_niu_page;  // the rest of linker/pe.ld's symbols are addresses only
extern const unsigned char image_code_end[];
void boot();
[[noreturn]] void boot_trap(std::uint32_t cause, std::uint32_t program_counter, std::uint32_t value);
}

namespace torolux::pe {
namespace {

static_assert(static_cast<int>(protocol::Hint::enter_phase) + static_cast<int>(protocol::Phase::program) == 72,
              "start.S has the marker as a number");

// Fields of a pmpcfg byte (RISC-V privileged manual, "Physical Memory Protection").
constexpr std::uint32_t kRead = 1;
constexpr std::uint32_t kWrite = 2;
constexpr std::uint32_t kExecute = 4;
constexpr std::uint32_t kUpToHere = 1U << 3U;  // TOR: from the address of the entry before
constexpr std::uint32_t kLocked = 1U << 7U;    // holds for machine mode, too, until reset

std::uint32_t pmp_address(std::uint32_t address) {
  return address >> 2U;
}

/// Code and read-only data may be read and executed, the rest of local memory read and written, and nothing else may be
/// touched: an access outside traps instead of reaching what QEMU has there.
void lock_memory(const Niu& niu) {
  const auto code_end = reinterpret_cast<std::uint32_t>(image_code_end);
  asm volatile("csrw pmpaddr0, %0" ::"r"(pmp_address(protocol::kLocalMemoryBase)));
  asm volatile("csrw pmpaddr1, %0" ::"r"(pmp_address(code_end)));
  asm volatile("csrw pmpaddr2, %0" ::"r"(pmp_address(niu.memory_end())));
  asm volatile("csrw pmpaddr3, %0" ::"r"(~std::uint32_t{0}));
  constexpr std::uint32_t nothing = kLocked | kUpToHere;
  constexpr std::uint32_t rights =
      nothing | ((nothing | kRead | kExecute) << 8U) | ((nothing | kRead | kWrite) << 16U) | (nothing << 24U);
  asm volatile("csrw pmpcfg0, %0" ::"r"(rights) : "memory");
}

Niu make_niu() {
  return Niu(image_niu_page, Memory(), HintGate());
}

}  // namespace
}  // namespace torolux::pe

extern "C" void boot() {
  torolux::pe::Niu niu = torolux::pe::make_niu();
  if (niu.window().protocol_version != torolux::protocol::kProtocolVersion) {
    niu.fail(torolux::protocol::FaultCode::protocol_version, torolux::protocol::kProtocolVersion,
             niu.window().protocol_version);
  }
  torolux::pe::lock_memory(niu);
  torolux::pe::pe_main(niu);
  niu.halt();
}

extern "C" [[noreturn]] void boot_trap(std::uint32_t cause, std::uint32_t program_counter, std::uint32_t value) {
  torolux::pe::make_niu().fail(torolux::protocol::FaultCode::trap, cause, program_counter, value);
}
