// SPDX-License-Identifier: MIT
// The benchmark's kernel as firmware: the result stands in the NIU window's detail[2] when it halts.
#include "tests/images/triangles.hpp"

#include "firmware/boot/boot.hpp"

void torolux::pe::pe_main(Niu& niu) {
  niu.window().fault.detail[2] = test::cross_triangles(test::kBenchRays);
}
