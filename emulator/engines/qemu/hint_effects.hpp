// SPDX-License-Identifier: MIT
// Which bytes of local memory a HINT writes: the NIU's side of the contract in firmware/protocol/hints.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/protocol/hints.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

/// After a HINT has happened: calls write(offset, bytes) for each stretch of local memory that it may have written.
/// Phase markers write nothing.
template <class Write>
void for_each_written(std::int32_t immediate, std::span<const std::byte> local_memory, std::uint32_t window_offset,
                      Write write) {
  using protocol::Hint;
  if (protocol::is_phase_marker(immediate)) return;
  const auto& window = *reinterpret_cast<const protocol::NiuWindow*>(local_memory.data() + window_offset);
  const auto write_field = [&](const void* field, std::size_t bytes) {
    write(static_cast<std::uint32_t>(static_cast<const std::byte*>(field) - local_memory.data()),
          static_cast<std::uint32_t>(bytes));
  };
  write_field(&window.released, sizeof window.released);
  const auto hint = static_cast<Hint>(immediate);
  if (hint == Hint::clock) write_field(&window.clock, sizeof window.clock);
  if (hint != Hint::receive && hint != Hint::receive_if_any && hint != Hint::receive_more &&
      hint != Hint::receive_due) {
    return;
  }
  write_field(&window.arrival, sizeof window.arrival);
  if (window.arrival.kind == protocol::ArrivalKind::message) {
    write_field(&window.message, sizeof window.message + window.message.bytes);
  } else if (window.arrival.kind == protocol::ArrivalKind::records) {
    const std::uint32_t slots = window.slots.address - protocol::kLocalMemoryBase;
    for (std::uint32_t i = 0; i < window.arrival.count; ++i) {
      write(slots + window.arrival.slots[i] * window.slots.bytes, window.slots.bytes);
    }
  }
}

}  // namespace torolux
