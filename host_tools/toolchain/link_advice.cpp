// SPDX-License-Identifier: MIT
// A table of what linkers say.
#include "host_tools/toolchain/link_advice.hpp"

#include <array>
#include <string_view>

namespace torolux {
namespace {

/// Where one of the texts stands, the advice holds, unless another text tells more. $: the number behind the text.
struct Advice {
  std::array<std::string_view, 8> texts;
  std::string_view advice;
  std::string_view unless{};
};

constexpr std::array kAdvice = std::to_array<Advice>({
    {{"undefined reference to `main'", "undefined reference to `torolux::pe::pe_main(torolux::pe::Niu&)'"},
     "the image has no beginning: define `int main(void)` or `int main(int argc, char** argv)` (in C++ not inside a "
     "namespace), or, without the C library's services, torolux::pe::pe_main (firmware/boot/boot.hpp)"},
    {{"region `local' overflowed by "},
     "the image is $ bytes larger than the largest local memory, 64 MiB: code, data and stack (--stack) together"},
    {{"image leaves no room for stores", "image is larger than its limit"},
     "the image is larger than the limit that -Wl,--defsym=torolux_image_limit=BYTES gave it",
     "' overflowed by "},
    {{"a static object has a constructor"},
     "an image with a pe_main of its own runs no constructors: mark the object constinit, make it in pe_main, or write "
     "main instead. Constructors are functions named _GLOBAL__sub_I_...: torolux cc -c, then riscv64-unknown-elf-nm, "
     "shows which file has one"},
    {{"a variable is thread-local", "`__cxa_thread_atexit'", "`__tls_get_addr'"},
     "a PE has one thread, and nothing sets up variables of threads: leave out thread_local (_Thread_local, __thread); "
     "a plain static variable is the same there"},
    {{"can't link soft-float modules with", "can't link single-float modules with", "can't link double-float modules",
      "can't link quad-float modules", "ABI is incompatible with that of the selected emulation",
      "can't link RVE with other target"},
     "objects of different ABIs cannot be one image. The kit's is ilp32f (-march=rv32imafc -mabi=ilp32f); compile "
     "everything for it. An image of ilp32 alone needs start-up code and libraries of its own: -nostdlib"},
    {{"__cxa_throw", "__cxa_begin_catch", "__cxa_allocate_exception", "__gxx_personality_v0", "_Unwind_Resume"},
     "there are no exceptions on a PE: leave out -fexceptions, throw and try, or the object that was compiled with "
     "them"},
    {{"vtable for __cxxabiv1::", "__dynamic_cast", "undefined reference to `typeinfo for"},
     "there is no run-time type information on a PE: leave out -frtti, dynamic_cast and typeid, or the object that was "
     "compiled with them",
     "__cxa_"},
    {{"`std::cout'", "`std::cerr'", "stream<char", "std::ios_base", "std::locale", "std::ostream::", "std::istream::"},
     "libstdc++'s streams and locales are not in the kit: use printf (docs/command_line.md says what is there)"},
    {{"`std::thread::", "`pthread_", "`std::filesystem::", "`std::random_device::", "`std::chrono::_V2::"},
     "threads, files as objects, random devices and the system's clocks of the C++ library are not on a PE: use "
     "torolux.h, fopen, a generator with a seed, and torolux_clock"},
    {{"undefined reference to `__atomic_"},
     "atomics of 8 bytes are not there: a PE has one thread, plain variables will do"},
});

std::string with_number(std::string_view advice, const std::string& errors, std::size_t behind) {
  const std::size_t place = advice.find('$');
  if (place == std::string_view::npos) return std::string(advice);
  const std::size_t end = errors.find_first_not_of("0123456789", behind);
  return std::string(advice.substr(0, place)) + errors.substr(behind, end - behind) +
         std::string(advice.substr(place + 1));
}

}  // namespace

std::vector<std::string> link_advice(const std::string& errors) {
  std::vector<std::string> found;
  for (const Advice& one : kAdvice) {
    if (!one.unless.empty() && errors.find(one.unless) != std::string::npos) continue;
    for (const std::string_view text : one.texts) {
      if (text.empty()) break;
      const std::size_t at = errors.find(text);
      if (at == std::string::npos) continue;
      found.push_back(with_number(one.advice, errors, at + text.size()));
      break;
    }
  }
  return found;
}

}  // namespace torolux
