// SPDX-License-Identifier: MIT
// From pe_main to main and on to exit. An image that defines pe_main itself leaves this file out of its link.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "firmware/boot/boot.hpp"
#include "firmware/kit/kit.hpp"
#include "firmware/protocol/host_services.hpp"

using torolux::protocol::Arguments;

extern "C" {
/// linker/pe.ld: an image with this symbol may have constructors of static objects.
extern const char torolux_runs_constructors;
const char torolux_runs_constructors = 1;
/// Not in .bss, which start-up clears: the emulator fills it in before.
extern Arguments torolux_arguments;
[[gnu::section(".data")]] Arguments torolux_arguments = {};

using Function = void (*)();
extern const Function image_constructors_begin[];  // linker/pe.ld
extern const Function image_constructors_end[];
extern const Function image_destructors_begin[];
extern const Function image_destructors_end[];

int main(int argc, char** argv);
int _write(int, const void*, std::size_t);
[[noreturn]] void _exit(int);
}

namespace torolux::kit {
namespace {

// The linker comes to the C library after this one: what that needs of it must have been asked for by then. Of what
// nobody calls nothing stays (--gc-sections).
using Any = void (*)();
[[gnu::used]] const Any of_system_calls = reinterpret_cast<Any>(&::_write);
[[gnu::used]] const Any of_ends = reinterpret_cast<Any>(&::_exit);

void run_destructors() {
  for (const Function* next = image_destructors_end; next != image_destructors_begin;) (*--next)();
}

/// argv, ended by a null pointer as C has it.
char** split(Arguments& arguments) {
  auto** const words = static_cast<char**>(std::malloc((arguments.count + 1) * sizeof(char*)));
  if (words == nullptr) end_run(Words() << "no memory for main's " << arguments.count << " arguments", nullptr);
  char* next = arguments.text.data();
  for (std::uint32_t word = 0; word < arguments.count; ++word) {
    words[word] = next;
    while (*next++ != '\0') continue;
  }
  words[arguments.count] = nullptr;
  return words;
}

}  // namespace
}  // namespace torolux::kit

void torolux::pe::pe_main(Niu& niu) {
  kit::begin(niu);
  if (+image_destructors_begin != +image_destructors_end) std::atexit(kit::run_destructors);
  for (const Function* next = image_constructors_begin; next != image_constructors_end; ++next) (*next)();
  char** const words = kit::split(torolux_arguments);
  std::exit(main(static_cast<int>(torolux_arguments.count), words));
}
