// SPDX-License-Identifier: MIT
// Holds the constants of torolux.h, which assembler reads, to the protocol: nothing enters, nothing leaves but an error
// of the compiler.
#include <cstddef>

#include "firmware/kit/include/torolux.h"
#include "firmware/protocol/hints.hpp"
#include "firmware/protocol/machine.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux::protocol {

static_assert(TOROLUX_PROTOCOL_VERSION == kProtocolVersion);

static_assert(TOROLUX_HINT_SEND_RECORDS == static_cast<int>(Hint::send_records));
static_assert(TOROLUX_HINT_SEND_MESSAGE == static_cast<int>(Hint::send_message));
static_assert(TOROLUX_HINT_RECEIVE == static_cast<int>(Hint::receive));
static_assert(TOROLUX_HINT_RECEIVE_IF_ANY == static_cast<int>(Hint::receive_if_any));
static_assert(TOROLUX_HINT_CLOCK == static_cast<int>(Hint::clock));
static_assert(TOROLUX_HINT_SET_SLOTS == static_cast<int>(Hint::set_slots));
static_assert(TOROLUX_HINT_HALT == static_cast<int>(Hint::halt));
static_assert(TOROLUX_HINT_FAIL == static_cast<int>(Hint::fail));
static_assert(TOROLUX_HINT_RECEIVE_MORE == static_cast<int>(Hint::receive_more));
static_assert(TOROLUX_HINT_RECEIVE_DUE == static_cast<int>(Hint::receive_due));
static_assert(TOROLUX_HINT_ENTER_PHASE == static_cast<int>(Hint::enter_phase));
static_assert(TOROLUX_HINT_LEAVE_PHASE == static_cast<int>(Hint::leave_phase));
static_assert(TOROLUX_FIRST_PHASE == static_cast<int>(Phase::count));

static_assert(TOROLUX_WINDOW_PROTOCOL_VERSION == offsetof(NiuWindow, protocol_version));
static_assert(TOROLUX_WINDOW_PE == offsetof(NiuWindow, pe));
static_assert(TOROLUX_WINDOW_COLUMNS == offsetof(NiuWindow, columns));
static_assert(TOROLUX_WINDOW_ROWS == offsetof(NiuWindow, rows));
static_assert(TOROLUX_WINDOW_MEMORY_BYTES == offsetof(NiuWindow, local_memory_bytes));
static_assert(TOROLUX_WINDOW_RETRY == offsetof(NiuWindow, retry));
static_assert(TOROLUX_WINDOW_CLOCK == offsetof(NiuWindow, clock));
static_assert(TOROLUX_WINDOW_ARRIVAL_KIND == offsetof(NiuWindow, arrival.kind));
static_assert(TOROLUX_WINDOW_ARRIVAL_SOURCE == offsetof(NiuWindow, arrival.source));
static_assert(TOROLUX_WINDOW_ARRIVAL_COUNT == offsetof(NiuWindow, arrival.count));
static_assert(TOROLUX_WINDOW_ARRIVAL_SLOTS == offsetof(NiuWindow, arrival.slots));
static_assert(TOROLUX_WINDOW_SLOTS_ADDRESS == offsetof(NiuWindow, slots.address));
static_assert(TOROLUX_WINDOW_SLOTS_BYTES == offsetof(NiuWindow, slots.bytes));
static_assert(TOROLUX_WINDOW_SLOTS_OWN == offsetof(NiuWindow, slots.own));
static_assert(TOROLUX_WINDOW_SLOTS_NIU == offsetof(NiuWindow, slots.niu));
static_assert(TOROLUX_WINDOW_SEND_DESTINATION == offsetof(NiuWindow, send.destination));
static_assert(TOROLUX_WINDOW_SEND_COUNT == offsetof(NiuWindow, send.count));
static_assert(TOROLUX_WINDOW_SEND_ADDRESS == offsetof(NiuWindow, send.address));
static_assert(TOROLUX_WINDOW_SEND_SLOTS == offsetof(NiuWindow, send.slots));
static_assert(TOROLUX_WINDOW_GATHER_CYCLES == offsetof(NiuWindow, gather.cycles));
static_assert(TOROLUX_WINDOW_GATHER_RECORDS == offsetof(NiuWindow, gather.records));
static_assert(TOROLUX_WINDOW_RELEASED == offsetof(NiuWindow, released));
static_assert(TOROLUX_WINDOW_RELEASE == offsetof(NiuWindow, release));
static_assert(TOROLUX_WINDOW_FAULT_CODE == offsetof(NiuWindow, fault.code));
static_assert(TOROLUX_WINDOW_FAULT_DETAIL == offsetof(NiuWindow, fault.detail));
static_assert(TOROLUX_WINDOW_MESSAGE_KIND == offsetof(NiuWindow, message.kind));
static_assert(TOROLUX_WINDOW_MESSAGE_SOURCE == offsetof(NiuWindow, message.source));
static_assert(TOROLUX_WINDOW_MESSAGE_BYTES == offsetof(NiuWindow, message.bytes));
static_assert(TOROLUX_WINDOW_MESSAGE == offsetof(NiuWindow, message_bytes));

static_assert(TOROLUX_TO_HOST == kHost);
static_assert(TOROLUX_TO_FRAME_BUFFER == kFrameBuffer);
static_assert(TOROLUX_MESSAGE_TEXT == static_cast<int>(MachineMessage::text));

}  // namespace torolux::protocol
