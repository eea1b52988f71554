// SPDX-License-Identifier: MIT
// Requests to the host and its answers; packets of other PEs that come meanwhile are taken in.
#include "firmware/kit/host_files.hpp"

#include <algorithm>
#include <cstring>

#include "firmware/kit/kit.hpp"

namespace torolux::kit {
namespace {

using protocol::MachineMessage;

/// The host's answer, its struct at the beginning.
template <class Head>
Head answer(MachineMessage kind) {
  const protocol::MessageHeader& message = messenger().receive_from_host();
  Head head{};
  if (message.kind != static_cast<std::uint16_t>(kind) || message.bytes < sizeof head) {
    end_run(
        Words() << "the host has answered with a message of kind " << message.kind << ", " << message.bytes << " bytes",
        nullptr);
  }
  std::memcpy(&head, messenger().niu().message_bytes().data(), sizeof head);
  return head;
}

/// Head, and a part of the bytes, as often as it takes.
template <class Head>
void tell_in_parts(MachineMessage kind, const Head& head, std::span<const std::byte> data) {
  while (!data.empty()) {
    const std::size_t part = std::min<std::size_t>(data.size(), protocol::kMostMessageBytes - sizeof head);
    tell_host(kind, head, data.data(), part);
    data = data.subspan(part);
  }
}

/// One request's worth.
std::size_t read_part(std::uint32_t file, std::span<std::byte> room) {
  const protocol::FileRead request{file, static_cast<std::uint32_t>(room.size())};
  tell_host(MachineMessage::file_read, request, nullptr, 0);
  std::size_t had = 0;
  for (;;) {
    const auto head = answer<protocol::FileData>(MachineMessage::file_data);
    const auto data = messenger().niu().message_bytes().subspan(sizeof head);
    const std::size_t part = std::min(data.size(), room.size() - had);
    if (part != 0) std::memcpy(room.data() + had, data.data(), part);
    had += part;
    if (head.left == 0) return had;
  }
}

}  // namespace

protocol::FileAnswer open_file(std::string_view name, std::uint32_t access) {
  if (name.empty() || name.size() > protocol::kMostFileName) return {protocol::FileError::no_such_file, 0, 0};
  tell_host(MachineMessage::file_open, protocol::FileOpen{access}, name.data(), name.size());
  return answer<protocol::FileAnswer>(MachineMessage::file_answer);
}

std::size_t read_file(std::uint32_t file, std::span<std::byte> room) {
  std::size_t had = 0;
  while (had < room.size()) {
    const std::size_t part = std::min<std::size_t>(room.size() - had, protocol::kMostReadBytes);
    const std::size_t came = read_part(file, room.subspan(had, part));
    had += came;
    if (came < part) break;
  }
  return had;
}

void write_file(std::uint32_t file, std::span<const std::byte> data) {
  tell_in_parts(MachineMessage::file_write, protocol::FileWrite{file}, data);
}

protocol::FileAnswer seek_file(std::uint32_t file, protocol::FileOrigin origin, std::int64_t offset) {
  tell_host(MachineMessage::file_seek, protocol::FileSeek{file, origin, offset}, nullptr, 0);
  return answer<protocol::FileAnswer>(MachineMessage::file_answer);
}

void close_file(std::uint32_t file) {
  tell_host(MachineMessage::file_close, protocol::FileClose{file}, nullptr, 0);
}

void write_output(protocol::OutputStream stream, std::span<const std::byte> data) {
  tell_in_parts(MachineMessage::output, protocol::Output{stream}, data);
}

}  // namespace torolux::kit
