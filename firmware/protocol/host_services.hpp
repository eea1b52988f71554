// SPDX-License-Identifier: MIT
// What a PE asks of the host that is no matter of its program: output, exit status, files, arguments. Each message is a
// MessageHeader with a MachineMessage and one of these structs.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/protocol/niu_window.hpp"

namespace torolux::protocol {

enum class OutputStream : std::uint32_t { standard_output = 1, standard_error = 2 };

/// Then the bytes, as they are: 1..kMostOutputBytes.
struct Output {
  OutputStream stream;
};
static_assert(sizeof(Output) == 4);
inline constexpr std::uint32_t kMostOutputBytes = kMostMessageBytes - sizeof(Output);

/// How a PE's program has ended, where that is not 0. The PE halts next.
struct ExitStatus {
  std::int32_t status;
};
static_assert(sizeof(ExitStatus) == 4);

/// What a program may do with a file that it opens: bits.
enum class FileAccess : std::uint32_t { read = 1, write = 2, append = 4, empty = 8 };
/// Then the name under which the user gave the file, without end mark: 1..kMostFileName bytes. Answer: FileAnswer.
struct FileOpen {
  std::uint32_t access;  ///< FileAccess: read, or write and what goes with it
};
static_assert(sizeof(FileOpen) == 4);
inline constexpr std::uint32_t kMostFileName = 255;
/// Of one PE, at a time.
inline constexpr std::uint32_t kMostOpenFiles = 16;

/// From the file's position on. Answer: FileData, one or more.
struct FileRead {
  std::uint32_t file;   ///< FileAnswer::file
  std::uint32_t bytes;  ///< 1..kMostReadBytes
};
static_assert(sizeof(FileRead) == 8);
inline constexpr std::uint32_t kMostReadBytes = 65536;
/// Then 0..kMostDataBytes bytes; fewer than were asked for: the file ends there.
struct FileData {
  std::uint32_t left;  ///< bytes of the answer that are still to come
};
static_assert(sizeof(FileData) == 4);
inline constexpr std::uint32_t kMostDataBytes = kMostMessageBytes - sizeof(FileData);

/// Then 1..kMostWriteBytes bytes, to the file's position, or its end. No answer.
struct FileWrite {
  std::uint32_t file;
};
static_assert(sizeof(FileWrite) == 4);
inline constexpr std::uint32_t kMostWriteBytes = kMostMessageBytes - sizeof(FileWrite);

enum class FileOrigin : std::uint32_t { begin = 0, position = 1, end = 2 };
/// Answer: FileAnswer with the new position. An offset of 0 from `position` changes nothing.
struct FileSeek {
  std::uint32_t file;
  FileOrigin origin;
  std::int64_t offset;  ///< [bytes]
};
static_assert(sizeof(FileSeek) == 16);

/// No answer.
struct FileClose {
  std::uint32_t file;
};
static_assert(sizeof(FileClose) == 4);

enum class FileError : std::uint32_t {
  none = 0,
  no_such_file,  ///< nobody has given that name
  not_allowed,   ///< an input to be written, or an output to be read
  too_many,      ///< more than kMostOpenFiles
  bad_position   ///< before the beginning, or beyond kMostFileBytes
};
/// The host's answer to FileOpen and FileSeek.
struct FileAnswer {
  FileError error;
  std::uint32_t file;      ///< 0..kMostOpenFiles-1
  std::uint64_t position;  ///< [bytes] from the beginning
};
static_assert(sizeof(FileAnswer) == 16);
inline constexpr std::uint64_t kMostFileBytes = std::uint64_t{1} << 40U;

/// What `torolux run IMAGE -- ...` hands to main: an object of an image, with this symbol, which the emulator fills in
/// before the start.
inline constexpr std::string_view kArgumentsSymbol = "torolux_arguments";
struct Arguments {
  static constexpr std::uint32_t kMostBytes = 4088;
  std::uint32_t count;                ///< the image's name included
  std::uint32_t bytes;                ///< of all, end marks included
  std::array<char, kMostBytes> text;  ///< one behind the other, each ended by a zero
};
static_assert(sizeof(Arguments) == 4096);

}  // namespace torolux::protocol
