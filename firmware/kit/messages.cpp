// SPDX-License-Identifier: MIT
// torolux.h: messages. Enters: pointers and sizes of C; leaves: what the messenger does with them.
#include <algorithm>
#include <cstddef>
#include <span>

#include "firmware/kit/include/torolux.h"
#include "firmware/kit/kit.hpp"

namespace torolux::kit {
namespace {

static_assert(TOROLUX_MOST_BYTES == kMostMessage && TOROLUX_ANY == kAnyPe);

std::span<const std::byte> bytes_at(const void* data, std::size_t bytes) {
  return {static_cast<const std::byte*>(data), bytes};
}

/// In as many messages of the bus as it takes.
void send_to_host(Messenger& messenger, std::span<const std::byte> data) {
  if (data.size() > kMostMessage) {
    messenger.fail(Words() << "a message of " << data.size() << " bytes; the most is " << kMostMessage);
  }
  while (!data.empty()) {
    const auto part = data.first(std::min<std::size_t>(data.size(), protocol::kMostMessageBytes));
    tell_host(protocol::MachineMessage::to_host, part);
    data = data.subspan(part.size());
  }
}

}  // namespace
}  // namespace torolux::kit

using torolux::kit::Channel;
using torolux::kit::messenger;

void torolux_send(int pe, const void* data, size_t bytes) {
  torolux::kit::Messenger& out = messenger("torolux_send", TOROLUX_CALLER);
  const auto contents = torolux::kit::bytes_at(data, bytes);
  if (pe == TOROLUX_HOST) return torolux::kit::send_to_host(out, contents);
  out.send(Channel::program, pe, contents);
}

size_t torolux_receive(int pe, void* data, size_t room) {
  return messenger("torolux_receive", TOROLUX_CALLER)
      .receive(Channel::program, pe, {static_cast<std::byte*>(data), room});
}

long torolux_waiting(int pe) {
  return static_cast<long>(messenger("torolux_waiting", TOROLUX_CALLER).waiting(Channel::program, pe));
}

unsigned torolux_source() {
  return messenger().source();
}

size_t torolux_exchange(int to, const void* data, size_t bytes, int from, void* in, size_t room) {
  return messenger("torolux_exchange", TOROLUX_CALLER)
      .exchange(to, torolux::kit::bytes_at(data, bytes), from, {static_cast<std::byte*>(in), room});
}
