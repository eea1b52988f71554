// SPDX-License-Identifier: MIT
// An image that does what a PE may not do; the number of rows of the torus says which. Its test: images_test.cpp.
#include "firmware/boot/boot.hpp"

namespace torolux::tests {
namespace {

volatile std::uint32_t sink = 0;

// Each call keeps 256 bytes on the stack.
// NOLINTNEXTLINE(misc-no-recursion): the recursion that never ends is the fault
std::uint32_t fill_stack(std::uint32_t depth) {
  volatile std::uint32_t frame[64];
  frame[depth % 64U] = depth;
  const std::uint32_t deeper = depth == 0xFFFF'FFFFU ? 0U : fill_stack(depth + 1U);
  return deeper + frame[depth % 64U];
}

volatile std::uint32_t& word_at(std::uint32_t address) {
  return *pe::Memory().at<volatile std::uint32_t>(address);
}

void commit_fault(pe::Niu& niu, std::uint32_t which) {
  const auto end = niu.memory_end();
  switch (which) {
    case 1:
      word_at(end) = 1;
      break;  // store after local memory
    case 2:
      sink = word_at(0x1000'0000U);
      break;  // load from where QEMU has a UART
    case 3:
      word_at(protocol::kLocalMemoryBase) = 1;
      break;  // store into code
    case 4:
      sink = fill_stack(1);
      break;                             // stack overflow
    case 5: {                            // execute the stores
      word_at(end - 4U) = 0x0000'8067U;  // ret
      reinterpret_cast<void (*)()>(end - 4U)();
      break;
    }
    case 6:
      asm volatile("unimp");
      break;  // no instruction
    case 7:
      niu.fail(protocol::FaultCode::bad_record, 5, 6);  // the program's own
    case 9:
      asm volatile(".4byte 0x02C5F553");  // fadd.d fa0,fa1,fa2: the PE has no double precision
      break;
    case 10:
      for (;;) asm volatile("");
    case 11:
      niu.receive();  // nothing will ever come
      break;
    case 12:
      asm volatile("slti zero,zero,2000");  // a HINT that the NIU does not know
      break;
    default:
      break;  // no fault: misaligned access and the last word work
  }
  word_at(end - 4U) = 0x1234'5678U;
  if (word_at(end - 4U) != 0x1234'5678U) niu.fail(protocol::FaultCode::bad_record, 1);
  word_at(end - 7U) = 0x0A0B'0C0DU;
  if (word_at(end - 7U) != 0x0A0B'0C0DU) niu.fail(protocol::FaultCode::bad_record, 2);
}

}  // namespace
}  // namespace torolux::tests

void torolux::pe::pe_main(Niu& niu) {
  tests::commit_fault(niu, niu.window().rows);
}
