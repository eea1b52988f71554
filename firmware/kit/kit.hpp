// SPDX-License-Identifier: MIT
// The one program of a PE: its messenger and its memory, which the functions of torolux.h and of the C library share.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

#include "firmware/kit/messenger.hpp"
#include "firmware/kit/words.hpp"

namespace torolux::kit {

/// Once, before all else: lays out the heap and sets the record slots.
void begin(pe::Niu& niu);

/// For a function of torolux.h that does nothing else wrong than its arguments.
Messenger& messenger();
/// The same: whatever goes wrong from here on, `function` was called, from `caller`.
Messenger& messenger(std::string_view function, const void* caller);

/// Ends the run with `words` and the place.
[[noreturn]] void end_run(const Words& words, const void* caller);

/// A message to the host: one of the machine's, with its contents.
void tell_host(protocol::MachineMessage kind, std::span<const std::byte> contents);
/// The same with the bytes that follow its struct.
template <class Head>
void tell_host(protocol::MachineMessage kind, const Head& head, const void* data, std::size_t bytes) {
  static_assert(std::is_trivially_copyable_v<Head>);
  pe::MessageBuffer& out = messenger().niu().batch();
  out.header.kind = static_cast<std::uint16_t>(kind);
  out.header.bytes = static_cast<std::uint32_t>(sizeof head + bytes);
  std::memcpy(out.bytes.data(), &head, sizeof head);
  if (bytes != 0) std::memcpy(out.bytes.data() + sizeof head, data, bytes);
  messenger().niu().send_message(protocol::kHost, out.header);
}

/// Where a call stands that returns to here: within the instruction of the call.
inline const void* call_before(const void* return_address) {
  return static_cast<const char*>(return_address) - 2;
}
#define TOROLUX_CALLER ::torolux::kit::call_before(__builtin_return_address(0))

/// Takes `first`, the heap's first byte, up to the end of local memory.
void begin_heap(std::uint32_t first, std::uint32_t end);
/// The heap's size.
std::uint32_t heap_bytes();
/// Where the C library itself needs memory that is not there.
[[noreturn]] void end_run_of_full_heap(const void* caller);

}  // namespace torolux::kit
