// SPDX-License-Identifier: MIT
// The heap of malloc: from the record slots to the end of local memory. Enters: how much more; leaves: where it is, a
// null pointer for the program, the end of the run for the C library, much of which takes for granted that there is
// memory.
#include <malloc.h>
#include <reent.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>

#include "firmware/kit/kit.hpp"

namespace torolux::kit {
namespace {

/// What the program's requests leave of the heap, for the C library's own: its three standard files and their buffers
/// take 4 KiB, the longest numbers of printf two more.
constexpr std::uint32_t kForLibrary = 8192;

constinit std::uint32_t heap_used = 0;  // address of the first byte that malloc does not have yet
constinit std::uint32_t heap_first = 0;
constinit std::uint32_t heap_end = 0;
constinit std::uint32_t kept_back = 0;  // of the heap, what whoever asks now may not have
constinit _mprec numbers{};             // of printf, which would ask as a program does

/// While it lives, memory is for the program.
struct ForProgram {
  ForProgram() { kept_back = kForLibrary; }
  ForProgram(const ForProgram&) = delete;
  ForProgram& operator=(const ForProgram&) = delete;
  ~ForProgram() { kept_back = 0; }
};

}  // namespace

void begin_heap(std::uint32_t first, std::uint32_t end) {
  heap_first = heap_used = first;
  heap_end = std::max(first, end);
  _REENT->_mp = &numbers;
}

std::uint32_t heap_bytes() {
  return heap_end - heap_first;
}

void end_run_of_full_heap(const void* caller) {
  end_run(Words() << "the heap is full, " << heap_bytes()
                  << " bytes, and the C library needs more of it (torolux run --pe-memory)",
          caller);
}

}  // namespace torolux::kit

extern "C" {

/// Of malloc, which returns a null pointer where this fails.
void* _sbrk(std::ptrdiff_t more) {
  using namespace torolux::kit;
  const std::int64_t next = std::int64_t{heap_used} + more;
  const bool is_there = next >= heap_first && next <= heap_end;
  if (!is_there || (more > 0 && next > std::int64_t{heap_end} - kept_back)) {
    if (kept_back == 0 && more > 0) end_run_of_full_heap(nullptr);
    errno = ENOMEM;
    return reinterpret_cast<void*>(-1);  // NOLINT(performance-no-int-to-ptr): as sbrk says that it fails
  }
  const std::uint32_t old = heap_used;
  heap_used = static_cast<std::uint32_t>(next);
  return reinterpret_cast<void*>(old);  // NOLINT(performance-no-int-to-ptr): addresses are numbers here
}

// What programs call; the C library itself calls what is behind these. Weak: a program may bring its own, which must
// not ask sbrk for more than there is.

[[gnu::weak]] void* malloc(std::size_t bytes) {
  const torolux::kit::ForProgram here;
  return _malloc_r(_REENT, bytes);
}
[[gnu::weak]] void free(void* memory) {
  _free_r(_REENT, memory);
}
/// newlib's own takes the product modulo 2^32.
[[gnu::weak]] void* calloc(std::size_t count, std::size_t bytes) {
  std::size_t all = 0;
  if (__builtin_mul_overflow(count, bytes, &all)) {
    errno = ENOMEM;
    return nullptr;
  }
  const torolux::kit::ForProgram here;
  return _calloc_r(_REENT, 1, all);
}
[[gnu::weak]] void* realloc(void* memory, std::size_t bytes) {
  const torolux::kit::ForProgram here;
  return _realloc_r(_REENT, memory, bytes);
}
[[gnu::weak]] void* memalign(std::size_t alignment, std::size_t bytes) {
  const torolux::kit::ForProgram here;
  return _memalign_r(_REENT, alignment, bytes);
}
/// Of aligned_alloc; newlib has none.
[[gnu::weak]] int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) {
  if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) return EINVAL;
  void* const there = ::memalign(alignment, bytes);
  if (there == nullptr) return ENOMEM;
  *memory = there;
  return 0;
}

}  // extern "C"
