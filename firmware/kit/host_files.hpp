// SPDX-License-Identifier: MIT
// Files as the host serves them. Enters: names, numbers of open files, bytes; leaves: messages to the host, its
// answers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "firmware/protocol/host_services.hpp"

namespace torolux::kit {

/// access: bits of protocol::FileAccess. FileAnswer::file is the number for the other calls.
protocol::FileAnswer open_file(std::string_view name, std::uint32_t access);
/// Fewer bytes than there is room for: the file ends there.
std::size_t read_file(std::uint32_t file, std::span<std::byte> room);
void write_file(std::uint32_t file, std::span<const std::byte> data);
protocol::FileAnswer seek_file(std::uint32_t file, protocol::FileOrigin origin, std::int64_t offset);
void close_file(std::uint32_t file);
void write_output(protocol::OutputStream stream, std::span<const std::byte> data);

}  // namespace torolux::kit
