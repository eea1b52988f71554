// SPDX-License-Identifier: MIT
// What C++ asks of its run-time library where there are no exceptions. Enters: calls of the compiler and of libstdc++'s
// headers; leaves: memory, or the end of the run.
#include <malloc.h>

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>

#include "firmware/kit/kit.hpp"

namespace torolux::kit {
namespace {

/// Longer words of an exception are cut.
constexpr std::size_t kMostWhatBytes = 160;

[[noreturn]] void refuse(std::size_t bytes, const void* caller) {
  end_run(Words() << "operator new: no memory for " << bytes << " bytes; the heap has " << heap_bytes()
                  << " in all (torolux run --pe-memory)",
          caller);
}

void* memory_or_end(std::size_t bytes, const void* caller) {
  void* const memory = std::malloc(bytes != 0 ? bytes : 1);
  if (memory == nullptr) refuse(bytes, caller);
  return memory;
}

void* aligned_or_end(std::size_t bytes, std::align_val_t alignment, const void* caller) {
  void* const memory = ::memalign(static_cast<std::size_t>(alignment), bytes != 0 ? bytes : 1);
  if (memory == nullptr) refuse(bytes, caller);
  return memory;
}

}  // namespace
}  // namespace torolux::kit

using torolux::kit::aligned_or_end;
using torolux::kit::end_run;
using torolux::kit::kMostWhatBytes;
using torolux::kit::memory_or_end;
using torolux::kit::Words;

void* operator new(std::size_t bytes) {
  return memory_or_end(bytes, TOROLUX_CALLER);
}
void* operator new[](std::size_t bytes) {
  return memory_or_end(bytes, TOROLUX_CALLER);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return aligned_or_end(bytes, alignment, TOROLUX_CALLER);
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return aligned_or_end(bytes, alignment, TOROLUX_CALLER);
}
void* operator new(std::size_t bytes, const std::nothrow_t& /*tag*/) noexcept {
  return std::malloc(bytes != 0 ? bytes : 1);
}
void* operator new[](std::size_t bytes, const std::nothrow_t& /*tag*/) noexcept {
  return std::malloc(bytes != 0 ? bytes : 1);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*bytes*/) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t /*bytes*/) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*bytes*/, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t /*bytes*/, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}

namespace std {
const nothrow_t nothrow{};
}

extern "C" {

/// Of static objects in shared libraries, of which there are none.
void* __dso_handle = nullptr;

[[noreturn]] void __cxa_pure_virtual() {
  end_run(Words() << "a pure virtual function was called", TOROLUX_CALLER);
}
[[noreturn]] void __cxa_deleted_virtual() {
  end_run(Words() << "a deleted virtual function was called", TOROLUX_CALLER);
}

// Objects that are static in a function, where the compiler locks them: there is one thread.
int __cxa_guard_acquire(std::uint64_t* guard) {
  return *reinterpret_cast<const char*>(guard) == 0 ? 1 : 0;
}
void __cxa_guard_release(std::uint64_t* guard) {
  *reinterpret_cast<char*>(guard) = 1;
}
void __cxa_guard_abort(std::uint64_t* /*guard*/) {}

}  // extern "C"

// What libstdc++'s headers call where a container is used wrongly.
namespace std {

[[noreturn]] void terminate() noexcept {
  end_run(Words() << "std::terminate", TOROLUX_CALLER);
}
void __throw_bad_exception() {
  end_run(Words() << "std::bad_exception", TOROLUX_CALLER);
}
void __throw_bad_alloc() {
  end_run(Words() << "std::bad_alloc: no memory", TOROLUX_CALLER);
}
void __throw_bad_array_new_length() {
  end_run(Words() << "std::bad_array_new_length: an array too large for any memory", TOROLUX_CALLER);
}
void __throw_bad_cast() {
  end_run(Words() << "std::bad_cast", TOROLUX_CALLER);
}
void __throw_bad_typeid() {
  end_run(Words() << "std::bad_typeid", TOROLUX_CALLER);
}
void __throw_logic_error(const char* what) {
  end_run(Words() << "std::logic_error: " << what, TOROLUX_CALLER);
}
void __throw_domain_error(const char* what) {
  end_run(Words() << "std::domain_error: " << what, TOROLUX_CALLER);
}
void __throw_invalid_argument(const char* what) {
  end_run(Words() << "std::invalid_argument: " << what, TOROLUX_CALLER);
}
void __throw_length_error(const char* what) {
  end_run(Words() << "std::length_error: " << what, TOROLUX_CALLER);
}
void __throw_out_of_range(const char* what) {
  end_run(Words() << "std::out_of_range: " << what, TOROLUX_CALLER);
}
void __throw_out_of_range_fmt(const char* format, ...) {
  char what[kMostWhatBytes];
  va_list values;
  va_start(values, format);
  vsnprintf(what, sizeof what, format, values);
  va_end(values);
  end_run(Words() << "std::out_of_range: " << what, TOROLUX_CALLER);
}
void __throw_runtime_error(const char* what) {
  end_run(Words() << "std::runtime_error: " << what, TOROLUX_CALLER);
}
void __throw_range_error(const char* what) {
  end_run(Words() << "std::range_error: " << what, TOROLUX_CALLER);
}
void __throw_overflow_error(const char* what) {
  end_run(Words() << "std::overflow_error: " << what, TOROLUX_CALLER);
}
void __throw_underflow_error(const char* what) {
  end_run(Words() << "std::underflow_error: " << what, TOROLUX_CALLER);
}
void __throw_system_error(int error) {
  end_run(Words() << "std::system_error: errno " << error, TOROLUX_CALLER);
}
void __throw_bad_function_call() {
  end_run(Words() << "std::bad_function_call: an empty std::function was called", TOROLUX_CALLER);
}

/// Of shared_ptr where there are no types at run time: whether it is this one.
bool _Sp_make_shared_tag::_S_eq(const type_info& /*type*/) noexcept {
  return false;
}

// Code that is not optimised expects these two from the library.
template class allocator<char>;
template class allocator<wchar_t>;

}  // namespace std
