// SPDX-License-Identifier: MIT
// The smallest image: each PE sends the host one line of text and halts.
#include "firmware/boot/boot.hpp"
#include "firmware/examples/text.hpp"

void torolux::pe::pe_main(Niu& niu) {
  examples::Text line;
  line << "Hello from PE " << niu.pe() << " of " << niu.pes();
  line.send(niu);
}
