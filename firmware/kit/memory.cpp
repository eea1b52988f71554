// SPDX-License-Identifier: MIT
// The heap of malloc: from the record slots to the end of local memory. Enters: how much more; leaves: where it is.
#include <cerrno>
#include <cstdint>

#include "firmware/kit/kit.hpp"

namespace torolux::kit {
namespace {

constinit std::uint32_t heap_used = 0;  // address of the first byte that malloc does not have yet
constinit std::uint32_t heap_first = 0;
constinit std::uint32_t heap_end = 0;

}  // namespace

void begin_heap(std::uint32_t first, std::uint32_t end) {
  heap_first = heap_used = first;
  heap_end = end < first ? first : end;
}

}  // namespace torolux::kit

/// Of malloc, which returns a null pointer where this fails.
extern "C" void* _sbrk(std::ptrdiff_t more) {
  using namespace torolux::kit;
  const std::int64_t next = std::int64_t{heap_used} + more;
  if (next < heap_first || next > heap_end) {
    errno = ENOMEM;
    return reinterpret_cast<void*>(-1);  // NOLINT(performance-no-int-to-ptr): as sbrk says that it fails
  }
  const std::uint32_t old = heap_used;
  heap_used = static_cast<std::uint32_t>(next);
  return reinterpret_cast<void*>(old);  // NOLINT(performance-no-int-to-ptr): addresses are numbers here
}
