// SPDX-License-Identifier: MIT
// The program's messenger, made before main; and the end of a run.
#include "firmware/kit/kit.hpp"

#include <array>
#include <new>

namespace torolux::kit {
namespace {

// No destructor: it lasts as long as the PE.
alignas(Messenger) constinit std::array<std::byte, sizeof(Messenger)> memory{};
constinit Messenger* the_messenger = nullptr;
constinit Words last_words;

}  // namespace

void begin(pe::Niu& niu) {
  const SlotLayout slots = slot_layout(protocol::kLocalMemoryBase, niu.memory_end());
  begin_heap(niu.memory().stores_begin(), slots.staging);
  the_messenger = new (memory.data()) Messenger(niu, slots);
}

Messenger& messenger() {
  return *the_messenger;
}

Messenger& messenger(std::string_view function, const void* caller) {
  the_messenger->called(function, caller);
  return *the_messenger;
}

void tell_host(protocol::MachineMessage kind, std::span<const std::byte> contents) {
  messenger().niu().send_message(protocol::kHost, static_cast<std::uint16_t>(kind), contents);
}

void end_run(const Words& words, const void* caller) {
  last_words = words;
  pe::Niu& niu = the_messenger->niu();
  niu.fail(pe::FaultCode::words, niu.memory().address_of(last_words.text().data()),
           static_cast<std::uint32_t>(last_words.text().size()),
           static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(caller)));
}

}  // namespace torolux::kit
