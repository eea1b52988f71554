// SPDX-License-Identifier: MIT
// The benchmark's kernel as firmware: the NIU window's detail[1] says how many rays, where it is not 0; the result
// stands in detail[2] when it halts.
#include "tests/images/triangles.hpp"

#include "firmware/boot/boot.hpp"

void torolux::pe::pe_main(Niu& niu) {
  const std::uint32_t rays = niu.window().fault.detail[1];
  niu.window().fault.detail[2] = test::cross_triangles(rays != 0 ? rays : test::kBenchRays);
}
