// SPDX-License-Identifier: MIT
// An image whose PEs say some lines to the host, of which PE 0 then ends as the number of rows of the torus says and
// the others halt. Its test: images_test.cpp.
#include "firmware/boot/boot.hpp"
#include "firmware/examples/text.hpp"

namespace torolux::tests {
namespace {

constexpr std::uint32_t kLines = 8;  // all of them may still stand in the outgoing queue when the PE ends

void end(std::uint32_t how) {
  switch (how) {
    case 1:
      asm volatile("unimp");
      break;
    case 2:
      for (;;) asm volatile("");
    case 3:
      asm volatile("wfi");
      break;
    case 4:
      asm volatile("slti zero,zero,2000");  // a HINT that the NIU does not know
      break;
    default:
      asm volatile("csrw mtvec, zero; unimp");  // a trap without a handler
      break;
  }
}

}  // namespace
}  // namespace torolux::tests

void torolux::pe::pe_main(Niu& niu) {
  const std::uint32_t pe = niu.window().pe;
  for (std::uint32_t line = 0; line < tests::kLines; ++line) {
    examples::Text text;
    text << "line " << line << " of PE " << pe;
    text.send(niu);
  }
  if (pe == 0) tests::end(niu.window().rows);
}
