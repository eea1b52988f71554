// SPDX-License-Identifier: MIT
// Local memory on the PE itself: an address is a pointer.
#pragma once

#include <cstdint>

extern "C" const unsigned char image_stores_begin[];  // linker/pe.ld

namespace torolux::pe {

class LocalBase {
 public:
  void* pointer(std::uint32_t address) const {
    return reinterpret_cast<void*>(address);  // NOLINT(performance-no-int-to-ptr): that is what an address is here
  }
  std::uint32_t address(const void* pointer) const { return reinterpret_cast<std::uint32_t>(pointer); }
  std::uint32_t stores_begin() const { return address(image_stores_begin); }
};

}  // namespace torolux::pe
