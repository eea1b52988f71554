// SPDX-License-Identifier: MIT
// An image whose PE 0 ends some calls deep, as the number of rows of the torus says; the others wait, also some calls
// deep, for what never comes. Its tests: backtrace_test.cpp, ending_test.cpp.
#include "firmware/boot/boot.hpp"

namespace torolux::tests {

/// Read by the tests.
constinit volatile std::uint32_t steps[4] = {};

namespace {

volatile std::uint32_t never = 0;

[[gnu::noinline]] void innermost(pe::Niu& niu, std::uint32_t how) {
  steps[2] = how;
  switch (how) {
    case 1:
      asm volatile("unimp");
      break;
    case 2:
      niu.fail(protocol::FaultCode::bad_record, 5, 6);
      break;
    case 3:
      for (;;) asm volatile("");
    case 4:
      niu.send_message(static_cast<protocol::PeNumber>(niu.pes()), 1, {});  // there is no such PE
      break;
    case 5:
      niu.receive();
      break;
    case 6:
      std::memset(pe::Memory().at<std::byte>(0x1000'0000U + never), 1, 64 + never);  // the C library's
      break;
    case 7:
      reinterpret_cast<void (*)()>(never)();
      break;
    default:
      break;
  }
  steps[3] = how;
}

[[gnu::noinline]] std::uint32_t middle(pe::Niu& niu, std::uint32_t how, std::uint32_t depth) {
  volatile std::uint32_t frame[16];
  frame[depth % 16U] = depth;
  if (depth < 3) return middle(niu, how, depth + 1) + frame[depth % 16U];
  innermost(niu, how);
  return frame[depth % 16U];
}

/// Never left: what its callers keep in registers is not needed any more.
[[noreturn, gnu::noinline]] void wait_for_ever(pe::Niu& niu) {
  for (;;) niu.receive();
}

/// A HINT each 100 cycles or so.
[[gnu::noinline]] void tick(pe::Niu& niu) {
  for (;;) {
    for (std::uint32_t i = 0; i < 20; ++i) steps[0] = steps[0] + 1;
    steps[1] = static_cast<std::uint32_t>(niu.clock());
  }
}

}  // namespace
}  // namespace torolux::tests

void torolux::pe::pe_main(Niu& niu) {
  const std::uint32_t rows = niu.window().rows;
  if (rows == 8) tests::tick(niu);
  if (rows == 9 && niu.pe() == 0) {
    for (;;) tests::never = tests::never + 1;
  }
  if (niu.pe() != 0) tests::wait_for_ever(niu);
  tests::steps[3] = tests::middle(niu, rows, 0);
}
