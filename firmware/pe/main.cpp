// SPDX-License-Identifier: MIT
// pe.elf's program: the state of this PE, in fixed memory, and its loop.
#include "firmware/boot/boot.hpp"
#include "firmware/pe/pe.hpp"

namespace torolux::pe {

void pe_main(Niu& niu) {
  static constinit Pe pe;
  run_pe(pe, niu);
}

}  // namespace torolux::pe
