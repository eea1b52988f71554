// SPDX-License-Identifier: MIT
// Messages of PEs, checked, into calls; answers into messages.
#include "host_tools/run/listener.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "emulator/errors.hpp"
#include "emulator/printable.hpp"
#include "firmware/protocol/host_services.hpp"

namespace torolux {
namespace {

using protocol::MachineMessage;

[[noreturn]] void malformed(PeNumber source, std::string_view name, std::size_t bytes) {
  throw MachineFailure("PE " + std::to_string(source) + " sent the host a message `" + std::string(name) + "` of " +
                       std::to_string(bytes) + " bytes, which it cannot have");
}

/// The struct at the beginning of a message; most: bytes that may follow it.
template <class Head, class Request>
Head head_of(const Request& request, std::size_t least, std::size_t most) {
  const std::size_t bytes = request.contents.size();
  if (bytes < sizeof(Head) + least || bytes > sizeof(Head) + most) malformed(request.source, request.name, bytes);
  Head head;
  std::memcpy(&head, request.contents.data(), sizeof head);
  return head;
}

std::string text_of(std::span<const std::byte> bytes) {
  std::string text(bytes.size(), '\0');
  std::ranges::transform(bytes, text.begin(), [](std::byte byte) { return static_cast<char>(byte); });
  return text;
}

void answer(HostPort& port, PeNumber pe, const protocol::FileAnswer& answer) {
  port.send_message(pe, static_cast<std::uint16_t>(MachineMessage::file_answer), std::as_bytes(std::span(&answer, 1)));
}

void send_data(HostPort& port, PeNumber pe, std::span<const std::byte> data) {
  do {
    const auto part = data.first(std::min<std::size_t>(data.size(), protocol::kMostDataBytes));
    data = data.subspan(part.size());
    const protocol::FileData head{static_cast<std::uint32_t>(data.size())};
    std::vector<std::byte> message(sizeof head + part.size());
    std::memcpy(message.data(), &head, sizeof head);
    std::ranges::copy(part, message.begin() + sizeof head);
    port.send_message(pe, static_cast<std::uint16_t>(MachineMessage::file_data), message);
  } while (!data.empty());
}

}  // namespace

Listener::Listener(ServedFiles& files, const std::function<void(const PeText&)>& on_text)
    : files_(files), on_text_(on_text), lines_(on_text) {}

void Listener::on_message(HostPort& port, PeNumber source, std::uint16_t kind, std::span<const std::byte> contents) {
  last_ = port.now();
  const auto request = [&](std::string_view name) { return Request{port, source, name, contents}; };
  switch (static_cast<MachineMessage>(kind)) {
    case MachineMessage::text:
      return text(request("text"));
    case MachineMessage::output:
      return output(request("output"));
    case MachineMessage::exit_status:
      return exit_status(request("exit_status"));
    case MachineMessage::to_host:
      return files_.append_to_host_file(source, contents);
    case MachineMessage::file_open:
      return file_open(request("file_open"));
    case MachineMessage::file_read:
      return file_read(request("file_read"));
    case MachineMessage::file_write:
      return file_write(request("file_write"));
    case MachineMessage::file_seek:
      return file_seek(request("file_seek"));
    case MachineMessage::file_close:
      return file_close(request("file_close"));
    default:
      throw MachineFailure("PE " + std::to_string(source) + " sent the host a message of kind " + std::to_string(kind) +
                           "; `torolux run` understands text (kind 1) and what firmware/kit sends (4 to 11) alone");
  }
}

void Listener::text(const Request& request) {
  on_text_({request.port.now(), request.source, printable(text_of(request.contents))});
}

void Listener::output(const Request& request) {
  const auto head = head_of<protocol::Output>(request, 1, protocol::kMostOutputBytes);
  const bool errors = head.stream == protocol::OutputStream::standard_error;
  if (!errors && head.stream != protocol::OutputStream::standard_output) {
    malformed(request.source, request.name, request.contents.size());
  }
  lines_.add(request.source, errors ? PeStream::errors : PeStream::output, request.port.now(),
             request.contents.subspan(sizeof head));
}

void Listener::exit_status(const Request& request) {
  const auto head = head_of<protocol::ExitStatus>(request, 0, 0);
  const PeExit exit{request.source, head.status, request.port.now()};
  if (exit.code() != 0 && !first_exit_) first_exit_ = exit;
}

void Listener::file_open(const Request& request) {
  const auto head = head_of<protocol::FileOpen>(request, 1, protocol::kMostFileName);
  answer(request.port, request.source,
         files_.open(request.source, head.access, text_of(request.contents.subspan(sizeof head))));
}

void Listener::file_read(const Request& request) {
  const auto head = head_of<protocol::FileRead>(request, 0, 0);
  send_data(request.port, request.source, files_.read(request.source, head));
}

void Listener::file_write(const Request& request) {
  const auto head = head_of<protocol::FileWrite>(request, 1, protocol::kMostWriteBytes);
  files_.write(request.source, head.file, request.contents.subspan(sizeof head));
}

void Listener::file_seek(const Request& request) {
  const auto head = head_of<protocol::FileSeek>(request, 0, 0);
  answer(request.port, request.source, files_.seek(request.source, head));
}

void Listener::file_close(const Request& request) {
  files_.close(request.source, head_of<protocol::FileClose>(request, 0, 0).file);
}

void Listener::finish() {
  lines_.finish(last_);
}

}  // namespace torolux
